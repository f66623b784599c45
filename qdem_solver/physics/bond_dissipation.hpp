// What the dashpot of one bond dissipates.
#pragma once

#include "qdem_solver/physics/bond_force.hpp"

namespace qdem {

/// c |d|'^2 of BondForce [W]. `Real`, scale and arguments as there.
template <class Real>
struct BondDissipation {
  static constexpr int n_particles = 2;
  static constexpr int n_shape = 1;

  Real scale;
  BondMaterial material;

  template <class Shape>
  HOUSE_HOST_DEVICE inline Real operator()(const Real* dx, const Real* dv, const Shape*, Shape stiffness) const {
    const Real along = dx[0] * dv[0] + dx[1] * dv[1] + dx[2] * dv[2];
    const Real distance2 = dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2];
    return (scale * stiffness) * (material.viscosity * (along * along / distance2));
  }
};

}  // namespace qdem
