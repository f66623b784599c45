// Figures of a patch that is compared with Hertz.
#pragma once

#include "fem_solver/contact/patch_grid.hpp"

namespace fem {

/// The ellipse p = p0 sqrt(1 - x2/a2 - y2/b2) that fits a pressure best.
struct PatchEllipse {
  double semi_axis_x = 0.0, semi_axis_y = 0.0;  ///< along and across the rail; 0 where the grid has one element [m]
  double peak_pressure = 0.0;                   ///< p0 [Pa]
};

/// Least squares in p2 over the elements in contact, about the centre of the grid.
PatchEllipse fit_ellipse(const PatchGrid& grid, const PatchField& pressure);

}  // namespace fem
