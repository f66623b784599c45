// Reading a profile file, and what can be wrong with one.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>

#include "fem_solver/model/columns.hpp"
#include "fem_solver/model/rail_outline.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double closed_within = 0.01, symmetric_within = 0.5;  // [mm]
constexpr double lowest_rail = 50.0, highest_rail = 300.0;      // [mm]
constexpr std::size_t most_points = 5000;

std::string millimetres(double value) {
  const std::string text = std::to_string(value);
  return text.substr(0, text.size() - 3) + " mm";
}

[[noreturn]] void refuse(const std::string& problem, const std::string& where, const std::string& advice) {
  throw proto::Error(proto::ExitCode::bad_data, "the rail profile " + problem, where, advice);
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a[0] * b[1] - a[1] * b[0];
}

bool edges_cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                 const Eigen::Vector2d& d) {
  const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
    return cross(q - p, r - p);
  };
  return side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
}

double signed_area(const Points& points) {
  SectionSums sums;
  for (std::size_t i = 0; i < points.size(); ++i) sums.add_edge(points[i], points[(i + 1) % points.size()]);
  return sums.area;
}

Eigen::AlignedBox<double, 2> box_of(const Points& points) {
  Eigen::AlignedBox<double, 2> box;
  for (const auto& p : points) box.extend(p);
  return box;
}

// Largest difference of the outline's two sides from the middle of its extent along `axis`, seen at fifty levels.
double asymmetry(const Points& points, int axis) {
  RailOutline turned{points};
  for (auto& p : turned.points) p = Eigen::Vector2d(p[axis], p[1 - axis]);
  const auto box = box_of(turned.points);
  const double middle = box.center()[0], low = box.min()[1], height = box.sizes()[1];
  double largest = 0.0;
  for (int level = 1; level < 50; ++level) {
    const auto y = turned.laterals_at(low + height * level / 50);
    if (!y.empty()) largest = std::max(largest, std::abs(y.front() + y.back() - 2 * middle));
  }
  return largest;
}

void check_simple(const Points& points, const std::vector<TwoColumns::Row>& rows, const std::string& path) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j)
      if ((j + 1) % n != i && edges_cross(points[i], points[i + 1], points[j], points[(j + 1) % n]))
        refuse("crosses itself (the edges after the points of lines " + std::to_string(rows[i].line) + " and " +
                   std::to_string(rows[j].line) + ")",
               path + ":" + std::to_string(rows[i].line), "give the points in their order along the outline");
}

// Width of the part near one end of the height.
double width_near(const Points& points, double z) {
  const auto y = RailOutline{points}.laterals_at(z);
  return y.empty() ? 0.0 : y.back() - y.front();
}

// `points`: as written, z down [mm].
void check_placing(const Points& points, const std::string& path) {
  const auto box = box_of(points);
  const double height = box.sizes()[1];
  if (box.sizes().maxCoeff() < 1.0)
    refuse("is " + std::to_string(height) + " mm high (written in metres?)", path,
           "the columns are millimetres: multiply them by 1000");
  const double lateral = asymmetry(points, 0);
  if (lateral > symmetric_within && asymmetry(points, 1) < lateral / 4)
    refuse("has its columns exchanged (it is symmetric in the second one)", path,
           "the first column is lateral, the second height, pointing down");
  if (height < lowest_rail || height > highest_rail)
    refuse("is " + millimetres(height) + " high, which no rail is", path,
           "the columns are millimetres: lateral, height pointing down");
  if (lateral > symmetric_within)
    refuse("is not symmetric (its sides differ by " + millimetres(lateral) + ")", path,
           "give an unworn profile with a vertical plane of symmetry, not inclined");
  const double top = width_near(points, box.min()[1] + 0.03 * height);
  const double bottom = width_near(points, box.max()[1] - 0.03 * height);
  if (top > bottom)
    refuse("stands on its head (it is " + millimetres(top) + " wide where z is least, " + millimetres(bottom) +
               " where it is largest)",
           path, "z points down, so that the foot has the largest z: change the sign of the second column");
}

}  // namespace

RailOutline read_rail_outline(const std::string& path) {
  const TwoColumns file(path, "rail profile", "y_mm, z_mm");
  const auto& rows = file.rows();
  if (rows.empty()) refuse("has no points", path, "give the outline");
  if (rows.size() > most_points)
    refuse("has " + std::to_string(rows.size()) + " points", path, "give at most " + std::to_string(most_points));
  Points points;
  for (const auto& row : rows) points.emplace_back(row.first, row.second);
  const double gap = (points.back() - points.front()).norm(), size = box_of(points).sizes().maxCoeff();
  if (gap > closed_within * std::min(1.0, size))
    refuse(
        "is not closed (its last point lies " + millimetres(gap) + " from its first)",
        path + ":" + std::to_string(rows.back().line),
        "repeat the first point at the end; a running surface alone is not enough, the outline goes around the foot");
  points.pop_back();
  if (points.size() < 12)
    refuse("has " + std::to_string(points.size()) + " points, too few for a rail", path, "give at least 12");
  check_simple(points, rows, path);
  check_placing(points, path);

  const auto box = box_of(points);
  RailOutline outline;
  for (const auto& p : points)
    outline.points.emplace_back((p[0] - box.center()[0]) * 1e-3, (box.max()[1] - p[1]) * 1e-3);
  if (signed_area(outline.points) < 0) std::reverse(outline.points.begin(), outline.points.end());
  return outline;
}

}  // namespace fem
