#include "qdem_solver/bed/sleeper_shape.hpp"

#include <algorithm>
#include <cmath>

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

int cells_along(double length, double cell) {
  return std::max(1, static_cast<int>(std::lround(length / cell)));
}

/// Bricks of six tetrahedra; `place(i, j, k)` is the node i-th along x, j-th along y, k-th along z.
template <class Place>
Template brick_mesh(const std::string& name, const std::array<int, 3>& n, Place place) {
  const auto number = [&](const std::array<int, 3>& at) { return (at[2] * (n[1] + 1) + at[1]) * (n[0] + 1) + at[0]; };
  std::vector<Vector3d> nodes;
  for (int k = 0; k <= n[2]; ++k) {
    for (int j = 0; j <= n[1]; ++j) {
      for (int i = 0; i <= n[0]; ++i) nodes.push_back(place(i, j, k));
    }
  }
  // The six ways from a cell's first corner to its last along its edges; the last three are left-handed.
  constexpr int ways[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
  std::vector<std::array<int, 4>> tets;
  for (int cell_id = 0; cell_id < n[0] * n[1] * n[2]; ++cell_id) {
    for (int w = 0; w < 6; ++w) {
      std::array<int, 3> at{cell_id % n[0], cell_id / n[0] % n[1], cell_id / n[0] / n[1]};
      std::array<int, 4> tet;
      tet[0] = number(at);
      for (int step = 0; step < 3; ++step) {
        ++at[ways[w][step]];
        tet[step + 1] = number(at);
      }
      if (w >= 3) std::swap(tet[2], tet[3]);
      tets.push_back(tet);
    }
  }
  return make_template(name, std::move(nodes), std::move(tets));
}

double between(double a, double b, double share) {
  return a + (b - a) * share;
}

SleeperSection between(const SleeperSection& a, const SleeperSection& b, double share) {
  return {between(a.place, b.place, share), between(a.height, b.height, share),
          between(a.bottom_width, b.bottom_width, share), between(a.top_width, b.top_width, share)};
}

double area(const SleeperSection& section) {
  return section.height * (section.bottom_width + section.top_width) / 2;
}

/// Cross-sections at the mesh's nodes.
std::vector<SleeperSection> stations(const SleeperShape& shape, double cell) {
  std::vector<SleeperSection> result{shape.sections.front()};
  for (std::size_t s = 1; s < shape.sections.size(); ++s) {
    const SleeperSection &a = shape.sections[s - 1], &b = shape.sections[s];
    const int n = cells_along(b.place - a.place, cell);
    for (int j = 1; j <= n; ++j) result.push_back(between(a, b, double(j) / n));
  }
  return result;
}

}  // namespace

double SleeperShape::height() const {
  double largest = 0.0;
  for (const auto& section : sections) largest = std::max(largest, section.height);
  return largest;
}

double SleeperShape::width() const {
  double largest = 0.0;
  for (const auto& section : sections) largest = std::max(largest, section.bottom_width);
  return largest;
}

double SleeperShape::bottom_area() const {
  double sum = 0.0;
  for (std::size_t s = 1; s < sections.size(); ++s) {
    const SleeperSection &a = sections[s - 1], &b = sections[s];
    sum += (b.place - a.place) * ((a.bottom_width + b.bottom_width) / 2);
  }
  return sum;
}

double SleeperShape::volume() const {
  double sum = 0.0;  // Simpson's rule: the area is quadratic in the place
  for (std::size_t s = 1; s < sections.size(); ++s) {
    const SleeperSection &a = sections[s - 1], &b = sections[s];
    sum += (b.place - a.place) * (area(a) + 4 * area(between(a, b, 0.5)) + area(b)) / 6;
  }
  return sum;
}

std::pair<double, double> SleeperShape::seat_range() const {
  const double top = height();
  std::pair<double, double> range{half_length(), 0.0};
  for (const auto& section : sections) {
    if (section.height < top) continue;
    range = {std::min(range.first, section.place), std::max(range.second, section.place)};
  }
  return range;
}

SleeperShape box_sleeper(double length, double width, double height) {
  return {{{0.0, height, width, width}, {length / 2, height, width, width}}};
}

SleeperShape tapered_sleeper(double length, std::pair<double, double> seat_range, const SleeperSection& centre,
                             const SleeperSection& seat, const SleeperSection& end) {
  SleeperShape shape{{centre, seat, seat, end}};
  const double places[] = {0.0, seat_range.first, seat_range.second, length / 2};
  for (int i = 0; i < 4; ++i) shape.sections[i].place = places[i];
  return shape;
}

SleeperShape known_sleeper(const std::string& name) {
  if (name == "3PR") {
    return tapered_sleeper(2.0, {0.466, 0.666}, {0, 0.150, 0.220, 0.155}, {0, 0.170, 0.240, 0.185},
                           {0, 0.150, 0.240, 0.175});
  }
  return tapered_sleeper(2.6, {0.6535, 0.8535}, {0, 0.175, 0.220, 0.150}, {0, 0.214, 0.300, 0.170},
                         {0, 0.180, 0.300, 0.152});
}

Template sleeper_mesh(const std::string& name, const SleeperShape& shape, int cells) {
  const double height = shape.height(), cell = height / cells;
  const auto along = stations(shape, cell);
  const std::array<int, 3> n{cells_along(shape.width(), cell), static_cast<int>(along.size()) - 1, cells};
  return brick_mesh(name, n, [&](int i, int j, int k) {
    const SleeperSection& section = along[j];
    const double width = between(section.bottom_width, section.top_width, double(k) / n[2]);
    return Vector3d(-width / 2 + width * (double(i) / n[0]), section.place,
                    -height + section.height * (double(k) / n[2]));
  });
}

Template box_shape(const std::string& name, const Vector3d& low, const Vector3d& high, double cell) {
  const Vector3d size = high - low;
  std::array<int, 3> n;
  for (int c = 0; c < 3; ++c) n[c] = cells_along(size[c], cell);
  return brick_mesh(name, n, [&](int i, int j, int k) -> Vector3d {
    return low + size.cwiseProduct(Vector3d(double(i) / n[0], double(j) / n[1], double(k) / n[2]));
  });
}

}  // namespace qdem::bed
