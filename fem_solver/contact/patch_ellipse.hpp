// Ellipses: what Hertz expects of a patch, the grid for it, and the ellipse that fits a computed pressure.
#pragma once

#include "fem_solver/contact/hertz.hpp"
#include "fem_solver/contact/patch_grid.hpp"

namespace fem {

/// Pressure p0 sqrt(1 - x2/a2 - y2/b2).
struct PatchEllipse {
  double semi_axis_x = 0.0, semi_axis_y = 0.0;  ///< along and across the rail; 0 where the grid has one element [m]
  double peak_pressure = 0.0;                   ///< p0 [Pa]
};

/// Of a wheel on a crown under a force [N]; the long axis lies along the larger radius.
PatchEllipse hertz_ellipse(double wheel_radius, double crown_radius, const ElasticBody& wheel, const ElasticBody& rail,
                           double force);

/// `elements` to each semi-axis and `margin` times the ellipse wide.
PatchGrid grid_around(const PatchEllipse& ellipse, int elements, double margin);

/// Least squares in p2 over the elements in contact, about the centre of the grid.
PatchEllipse fit_ellipse(const PatchGrid& grid, const PatchField& pressure);

}  // namespace fem
