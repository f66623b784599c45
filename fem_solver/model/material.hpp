// Elastic material of a rail.
#pragma once

namespace fem {

constexpr double gravity = 9.81;  ///< [m/s2]

/// Isotropic linear elastic material.
struct Material {
  double young = 210e9;  ///< [Pa]
  double poisson = 0.3;
  double density = 7850;  ///< [kg/m3]

  double shear_modulus() const { return young / (2 * (1 + poisson)); }  ///< [Pa]
};

}  // namespace fem
