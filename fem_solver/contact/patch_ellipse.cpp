#include "fem_solver/contact/patch_ellipse.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace fem {

PatchEllipse hertz_ellipse(double wheel_radius, double crown_radius, const ElasticBody& wheel, const ElasticBody& rail,
                           double force) {
  const HertzState s = Hertz(wheel_radius, crown_radius, wheel, rail).at_force(force);
  const bool long_along = wheel_radius >= crown_radius;
  return {long_along ? s.semi_axis_long : s.semi_axis_short, long_along ? s.semi_axis_short : s.semi_axis_long,
          s.peak_pressure};
}

PatchGrid grid_around(const PatchEllipse& ellipse, int elements, double margin) {
  const int side = 2 * static_cast<int>(std::ceil(margin * elements));
  return {side, side, ellipse.semi_axis_x / elements, ellipse.semi_axis_y / elements};
}

PatchEllipse fit_ellipse(const PatchGrid& grid, const PatchField& pressure) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int j = 0; j < grid.n_y; ++j)
    for (int i = 0; i < grid.n_x; ++i) {
      if (pressure(i, j) <= 0) continue;
      // In units of elements, so that the three columns are of one size.
      const Eigen::Vector3d row(1.0, -std::pow(grid.x(i) / grid.dx, 2), -std::pow(grid.y(j) / grid.dy, 2));
      normal += row * row.transpose();
      right += row * std::pow(pressure(i, j), 2);
    }
  const Eigen::Vector3d c = normal.completeOrthogonalDecomposition().solve(right);
  const auto semi_axis = [&](int k, double side) { return c[k] > 0 ? side * std::sqrt(c[0] / c[k]) : 0.0; };
  return {semi_axis(1, grid.dx), semi_axis(2, grid.dy), std::sqrt(std::max(c[0], 0.0))};
}

}  // namespace fem
