// A straight Timoshenko beam element in space.
#pragma once

#include <Eigen/Core>

#include "fem_solver/model/material.hpp"
#include "fem_solver/model/rail_section.hpp"

namespace fem {

/// Two nodes along x with displacement x, y, z and rotation about x, y, z each: 12 degrees of freedom. Displacement and
/// rotation of the cross-section follow from the exact solution without distributed load (cubic and quadratic, joined
/// by the shear parameter), so that the element does not lock and is exact in statics for loads on the nodes. Source:
/// Przemieniecki, Theory of Matrix Structural Analysis, chapter 5 (stiffness); mass and rotary inertia follow from the
/// same shape functions. Twist is Saint-Venant's, about the centroid: warping and the shear centre's offset are left
/// out.
class BeamElement {
 public:
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  using Rows = Eigen::Matrix<double, 6, 12>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;

  /// `length` [m], positive.
  BeamElement(const RailSection& section, const Material& material, double length);

  /// Displacement x, y, z and rotation about x, y, z of the cross-section at the share `s` (0 to 1) of the length.
  Rows motion(double s) const;

  /// Elongation, shear along y and z, twist [1/m], curvature in the x-y and in the x-z plane [1/m], second derivatives
  /// of displacement in the absence of shear.
  Rows strain(double s) const;

  /// Section stiffness for each strain [N, N m2].
  const Vector6& section_stiffness() const { return stiffness_; }

  Matrix12 stiffness() const;  ///< [N/m, N, N m]
  Matrix12 mass() const;       ///< consistent, with rotary inertia [kg, kg m, kg m2]

  /// Vertical deflection at `s` per unit force there when both ends are clamped [m/N]: what a force between the nodes
  /// does beyond the motion of the nodes.
  double clamped_flexibility(double s) const;

 private:
  double length_, shear_lateral_, shear_vertical_;  // shear parameter 12 E I/(kappa G A L^2) of each plane
  Vector6 stiffness_, inertia_;                     // inertia per length: kg/m three times, kg m three times
};

}  // namespace fem
