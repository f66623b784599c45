#include "fem_solver/model/section_blocks.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace fem {
namespace {

[[noreturn]] void refuse(const std::string& reason, const std::string& where) {
  throw proto::Error(proto::ExitCode::bad_data, "the rail profile cannot be cut into blocks: " + reason, where,
                     "give the outline of a flat-bottomed rail with foot, web and head");
}

// What a fit may move: corner and component.
struct Coordinate {
  int corner, component;
};
constexpr Coordinate movable[] = {{3, 1}, {4, 1},  {5, 1},  {6, 0},  {7, 0},  {8, 0},
                                  {9, 0}, {10, 1}, {11, 0}, {11, 1}, {12, 0}, {12, 1}};
constexpr int n_movable = sizeof(movable) / sizeof(movable[0]);

// Relative departure from the target.
Eigen::VectorXd departure(const HalfCorners& corners, const SectionTarget& target) {
  const SectionProperties p = block_section(corners).properties();
  Eigen::VectorXd d(target.centroid_height > 0 ? 4 : 3);
  d[0] = p.area / target.area - 1;
  d[1] = p.inertia_vertical / target.inertia_vertical - 1;
  d[2] = p.inertia_lateral / target.inertia_lateral - 1;
  if (d.size() == 4) d[3] = p.centroid_height / target.centroid_height - 1;
  return d;
}

bool convex(const RailSection& section) {
  for (const auto& quad : section.quads) {
    const int ring[4] = {quad[0], quad[1], quad[3], quad[2]};
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d &a = section.vertices[ring[k]], &b = section.vertices[ring[(k + 1) % 4]],
                            &c = section.vertices[ring[(k + 2) % 4]];
      if ((b - a)[0] * (c - b)[1] - (b - a)[1] * (c - b)[0] <= 0) return false;
    }
  }
  return true;
}

std::string millimetres(double metres) {
  return std::to_string(metres * 1e3).substr(0, 5) + " mm";
}

// The outline read as a rail: sides and faces.
class RailShapeReader {
 public:
  RailShapeReader(const RailOutline& outline, const std::string& where) : outline_(outline), where_(where) {
    const double h = outline.height();
    for (int level = 1; level < 200; ++level) {
      const double z = h * level / 200, half = side(z);
      if (level < 60) foot_ = std::max(foot_, half);
      if (level > 140) head_ = std::max(head_, half);
      if (level >= 50 && level <= 140) web_ = std::min(web_, half);
    }
    if (!(web_ < 0.6 * std::min(foot_, head_)))
      refuse("it has no web (half-widths of foot, web and head: " + millimetres(foot_) + ", " + millimetres(web_) +
                 ", " + millimetres(head_) + ")",
             where);
    if (head_ > foot_) refuse("its head is wider than its foot", where);
  }

  double foot() const { return foot_; }
  double web() const { return web_; }
  double head() const { return head_; }
  double side(double z) const {
    const auto y = outline_.laterals_at(z);
    if (y.size() != 2)
      refuse("the horizontal line at z = " + millimetres(z) + " above the foot meets it " + std::to_string(y.size()) +
                 " times",
             where_);
    return (y[1] - y[0]) / 2;
  }
  double foot_top(double y) const { return faces(y)[1]; }
  double head_underside(double y) const { return faces(y).rbegin()[1]; }
  double head_top(double y) const { return faces(y).back(); }

 private:
  std::vector<double> faces(double y) const {
    const auto z = outline_.heights_at(y);
    if (z.size() != 2 && z.size() != 4)
      refuse("the vertical line at y = " + millimetres(y) + " meets it " + std::to_string(z.size()) + " times", where_);
    return z;
  }
  const RailOutline& outline_;
  const std::string& where_;
  double foot_ = 0.0, head_ = 0.0, web_ = 1e3;
};

}  // namespace

RailSection block_section(const HalfCorners& corners) {
  RailSection s;
  for (const double side : {1.0, -1.0})
    for (const auto& p : corners) s.vertices.emplace_back(side * p[0], p[1]);
  const auto left = [](int right) { return right + n_half_corners; };
  const auto across = [&](int low, int high) { s.quads.push_back({left(low), low, left(high), high}); };
  const auto both = [&](int a, int b, int c, int d) {
    s.quads.push_back({a, b, c, d});
    s.quads.push_back({left(b), left(a), left(d), left(c)});
  };
  across(0, 5);
  both(0, 1, 5, 4);
  both(1, 2, 4, 3);
  for (int row = 5; row < 10; ++row) across(row, row + 1);
  across(10, 13);
  both(10, 11, 13, 12);
  s.head_half_width = corners[13][0];
  s.head_height = corners[13][1];
  s.foot_half_width = corners[2][0];
  return s;
}

HalfCorners fit_corners(HalfCorners corners, const SectionTarget& target, double limit, const std::string& where) {
  const HalfCorners first = corners;
  const double step = 1e-7;  // [m]
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Eigen::VectorXd d = departure(corners, target);
    if (d.lpNorm<Eigen::Infinity>() < 1e-9) break;
    Eigen::MatrixXd slope(d.size(), n_movable);
    for (int k = 0; k < n_movable; ++k) {
      HalfCorners moved = corners;
      moved[movable[k].corner][movable[k].component] += step;
      slope.col(k) = (departure(moved, target) - d) / step;
    }
    // Least change that removes the departure.
    const Eigen::VectorXd change = slope.transpose() * (slope * slope.transpose()).ldlt().solve(-d);
    for (int k = 0; k < n_movable; ++k) corners[movable[k].corner][movable[k].component] += change[k];
  }
  double largest = 0.0;
  for (int k = 0; k < n_half_corners; ++k) largest = std::max(largest, (corners[k] - first[k]).norm());
  if (!(departure(corners, target).lpNorm<Eigen::Infinity>() < 1e-9) || largest > limit)
    refuse("to keep its area and second moments a corner would have to move by " + millimetres(largest), where);
  if (!convex(block_section(corners))) refuse("a block would not be convex", where);
  return corners;
}

HalfCorners corners_of(const RailOutline& outline, const std::string& where) {
  const RailShapeReader rail(outline, where);
  const double foot = rail.foot(), web = rail.web(), head = rail.head();
  const double foot_inner = std::max(0.28 * foot, 1.5 * web), foot_middle = (foot_inner + foot) / 2;
  const double head_inner = std::max(0.34 * head, 1.4 * web);
  const double lowest = rail.foot_top(foot_inner), highest = rail.head_underside(head_inner);
  if (!(highest > 1.5 * lowest)) refuse("its head lies too near to its foot", where);
  // The outermost corners stand for rounded ones: the faces go on straight to the full width.
  const auto straight_to = [](double at, double y_1, double z_1, double y_2, double z_2) {
    return z_2 + (z_2 - z_1) / (y_2 - y_1) * (at - y_2);
  };
  const double foot_edge =
      straight_to(foot, foot_middle, rail.foot_top(foot_middle), 0.95 * foot, rail.foot_top(0.95 * foot));
  const double head_edge = straight_to(head, head_inner, highest, 0.85 * head, rail.head_underside(0.85 * head));
  const auto web_corner = [&](double share) {
    const double z = lowest + share * (highest - lowest);
    return Eigen::Vector2d(rail.side(z), z);
  };
  return {{foot_inner, 0.0},
          {foot_middle, 0.0},
          {foot, 0.0},
          {foot, foot_edge},
          {foot_middle, rail.foot_top(foot_middle)},
          {foot_inner, lowest},
          web_corner(0.08),
          web_corner(0.20),
          web_corner(0.55),
          web_corner(0.92),
          {head_inner, highest},
          {head, head_edge},
          {0.96 * head, rail.head_top(0.9 * head)},
          {head_inner, rail.head_top(head_inner)}};
}

}  // namespace fem
