#include "fem_solver/model/rail_outline.hpp"

#include <algorithm>
#include <cmath>

namespace fem {

void SectionSums::add_edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double cross = a[0] * b[1] - a[1] * b[0];
  area += cross / 2;
  first += cross * (a[1] + b[1]) / 6;
  second_z += cross * (a[1] * a[1] + a[1] * b[1] + b[1] * b[1]) / 12;
  second_y += cross * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) / 12;
}

SectionProperties SectionSums::properties() const {
  return {area, first / area, second_z - first * first / area, second_y};
}

SectionProperties RailOutline::properties() const {
  SectionSums sums;
  for (std::size_t i = 0; i < points.size(); ++i) sums.add_edge(points[i], points[(i + 1) % points.size()]);
  return sums.properties();
}

double RailOutline::height() const {
  double highest = 0.0;
  for (const auto& p : points) highest = std::max(highest, p[1]);
  return highest;
}

std::vector<double> RailOutline::crossings(int axis, double value) const {
  std::vector<double> found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto &a = points[i], &b = points[(i + 1) % points.size()];
    // Half-open edges: a corner on the line counts once where the outline crosses and not where it only touches.
    if ((a[axis] <= value) == (b[axis] <= value)) continue;
    const double s = (value - a[axis]) / (b[axis] - a[axis]);
    found.push_back(a[1 - axis] + s * (b[1 - axis] - a[1 - axis]));
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace fem
