// Force of one bond: two particles joined by a spring and a dashpot, as in ordinary DEM.
#pragma once

#include "qdem_solver/physics/square_root.hpp"

namespace qdem {

/// Material of a bond as the functor reads it.
struct BondMaterial {
  double young;      ///< [Pa]
  double viscosity;  ///< in uniaxial tension [Pa s]
};

/// Voigt model along the line between the particles, d = x_2 - x_1:
///     f = k (|d| - L) + c |d|'       tension [N],   k = E w,  c = eta w
/// Central, so linear and angular momentum are kept to round-off and finite rotation is exact. A solid of such bonds is
/// a Voigt model in one dimension only: it has neither the Poisson's ratio nor the shear and bulk modulus asked for.
/// Source: bonded DEM; the comparison in Nishiura et al. 2018.
///
/// `Real` as in QuadrupleForce. A body of scale s has s L and s w.
template <class Real>
struct BondForce {
  static constexpr int n_particles = 2;
  static constexpr int n_shape = 1;

  Real scale;
  BondMaterial material;

  /// dx, dv: position and velocity of particle 2 relative to particle 1. length: L of the template [m], stiffness: w,
  /// the bond's stiffness over E [m]. force: on particle 2 [N].
  template <class Shape>
  HOUSE_HOST_DEVICE inline void operator()(const Real* dx, const Real* dv, const Shape* length, Shape stiffness,
                                           Real* force) const {
    const Real distance = square_root(dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]);
    const Real rate = (dx[0] * dv[0] + dx[1] * dv[1] + dx[2] * dv[2]) / distance;
    const Real stress = material.young * (distance - scale * length[0]) + material.viscosity * rate;
    const Real factor = (scale * (-stiffness)) * stress / distance;
    for (int c = 0; c < 3; ++c) force[c] = factor * dx[c];
  }

  /// Energy of the spring [J]; arguments as above.
  HOUSE_HOST_DEVICE inline Real energy(const Real* dx, Real length, Real stiffness) const {
    const Real longer = square_root(dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2]) - scale * length;
    return 0.5 * material.young * scale * stiffness * longer * longer;
  }
};

}  // namespace qdem
