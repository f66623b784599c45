// The grid of rectangular elements on which a contact patch is resolved.
#pragma once

#include <Eigen/Core>

namespace fem {

/// One value per element: rows along x (the way the wheel rolls), columns along y (across the rail).
using PatchField = Eigen::ArrayXXd;

/// n_x times n_y equal rectangles about the grid's centre. The grid travels with the patch.
struct PatchGrid {
  int n_x = 1, n_y = 1;
  double dx = 1.0, dy = 1.0;  ///< sides of an element [m]

  double x(int i) const { return (i - 0.5 * (n_x - 1)) * dx; }  ///< centre of an element [m]
  double y(int j) const { return (j - 0.5 * (n_y - 1)) * dy; }  ///< [m]
  double area() const { return dx * dy; }                       ///< of an element [m2]
  PatchField zeros() const { return PatchField::Zero(n_x, n_y); }
};

/// Elements i_begin <= i < i_begin + n_i, j likewise.
struct PatchBox {
  int i_begin = 0, j_begin = 0, n_i = 0, n_j = 0;

  bool empty() const { return n_i == 0; }
};

/// The smallest box that holds every element where `inside` is true.
PatchBox bounding_box(const Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>& inside);

/// Throws proto::Error (numerics) if an element at the edge of the grid carries pressure; a direction with one element
/// has no edge. `where`: for the message.
void require_inside(const PatchField& pressure, const char* where);

}  // namespace fem
