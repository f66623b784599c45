// What the viscosity of one quadruple dissipates.
#pragma once

#include "qdem_solver/physics/quadruple_force.hpp"

namespace qdem {

/// Power of the viscous stress of QuadrupleForce, V (lambda_v tr(E')^2 + 2 mu_v E' : E') [W]: never negative.
/// `Real`, scale and arguments as there.
template <class Real>
struct QuadrupleDissipation {
  static constexpr int n_particles = 4;
  static constexpr int n_shape = 9;

  Real inverse_scale;
  QuadrupleMaterial material;

  template <class Shape>
  HOUSE_HOST_DEVICE inline Real operator()(const Real* dx, const Real* dv, const Shape* g, Shape volume) const {
    Real f[9], r[9];  // s F and s F'
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        f[3 * i + j] = dx[i] * g[j] + dx[3 + i] * g[3 + j] + dx[6 + i] * g[6 + j];
        r[3 * i + j] = dv[i] * g[j] + dv[3 + i] * g[3 + j] + dv[6 + i] * g[6 + j];
      }
    }
    Real rate[9];  // 2 s^2 E'
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) rate[3 * a + b] = rate[3 * b + a] = dot(f, a, r, b) + dot(f, b, r, a);
    }
    const Real trace = rate[0] + rate[4] + rate[8];
    Real square = rate[0] * rate[0];
    for (int i = 1; i < 9; ++i) square = square + rate[i] * rate[i];
    // s^3 V_t / (2 s^2)^2 of the sums above.
    return (inverse_scale * (0.25 * volume)) *
           (material.lame_viscosity * (trace * trace) + (2.0 * material.shear_viscosity) * square);
  }

 private:
  HOUSE_HOST_DEVICE static inline Real dot(const Real* p, int a, const Real* q, int b) {
    return p[a] * q[b] + p[3 + a] * q[3 + b] + p[6 + a] * q[6 + b];
  }
};

}  // namespace qdem
