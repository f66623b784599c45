// Force of one quadruple: four particles that interact as a constant-strain viscoelastic solid under finite rotation.
#pragma once

#include "proto/span.hpp"

namespace qdem {

/// Material of a quadruple as the functor reads it.
struct QuadrupleMaterial {
  double lambda, mu;                       ///< Lame constants [Pa]
  double lame_viscosity, shear_viscosity;  ///< [Pa s]
};

/// St Venant-Kirchhoff with Kelvin-Voigt viscosity in the reference frame:
///     E = (F^T F - I)/2,  E' = sym(F^T F'),  S = lambda tr(E) I + 2 mu E + lambda_v tr(E') I + 2 mu_v E',  P = F S,
///     force on particle k: f_k = -V P g_k,  f_1 = -(f_2 + f_3 + f_4)
/// Objective, and P F^T is symmetric, so linear and angular momentum are kept to round-off. Valid for |strain| < 1e-2.
/// Source: standard continuum mechanics of the constant-strain tetrahedron.
///
/// `Real` is double or a vector of doubles with the arithmetic operators: one body a lane, all of one reference shape.
/// A body of scale s has F = (1/s) sum x_k (x) g_k and V = s^3 V_t with the template's g_k and V_t; the functor works
/// with s F and folds the powers of s into its coefficients.
template <class Real>
struct QuadrupleForce {
  static constexpr int n_particles = 4;
  static constexpr int n_shape = 9;  ///< values of g

  Real scale_squared;  ///< s^2 per lane
  Real inverse_scale;  ///< 1/s per lane
  QuadrupleMaterial material;

  /// dx, dv: positions and velocities of particles 2, 3, 4 relative to particle 1, [3 * particle + component].
  /// g: rows of Dm^-1 of the template, volume: V_t; `Shape` is double where all lanes share one element, Real where
  /// every lane holds another one. force: on particles 2, 3, 4, same order [N].
  template <class Shape>
  HOUSE_HOST_DEVICE inline void operator()(const Real* dx, const Real* dv, const Shape* g, Shape volume,
                                           Real* force) const {
    Real f[9], r[9];  // s F and s F', rows i, columns j
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        f[3 * i + j] = dx[i] * g[j] + dx[3 + i] * g[3 + j] + dx[6 + i] * g[6 + j];
        r[3 * i + j] = dv[i] * g[j] + dv[3 + i] * g[3 + j] + dv[6 + i] * g[6 + j];
      }
    }
    // 2 s^2 E and 2 s^2 E'; xx yy zz xy yz zx.
    const Real e[6] = {dot(f, 0, f, 0) - scale_squared,
                       dot(f, 1, f, 1) - scale_squared,
                       dot(f, 2, f, 2) - scale_squared,
                       dot(f, 0, f, 1),
                       dot(f, 1, f, 2),
                       dot(f, 2, f, 0)};
    const Real d[6] = {2.0 * dot(f, 0, r, 0),
                       2.0 * dot(f, 1, r, 1),
                       2.0 * dot(f, 2, r, 2),
                       dot(f, 0, r, 1) + dot(f, 1, r, 0),
                       dot(f, 1, r, 2) + dot(f, 2, r, 1),
                       dot(f, 2, r, 0) + dot(f, 0, r, 2)};
    // -V S of the scaled body, times 1: -(V_t / s) (s^2 S) (s F) g = -s^2 V_t (F S) g.
    const Real factor = inverse_scale * (-volume);
    const Real m = factor * material.mu, mv = factor * material.shear_viscosity;
    const Real pressure = (factor * (0.5 * material.lambda)) * (e[0] + e[1] + e[2]) +
                          (factor * (0.5 * material.lame_viscosity)) * (d[0] + d[1] + d[2]);
    Real s[6];
    for (int i = 0; i < 3; ++i) s[i] = m * e[i] + mv * d[i] + pressure;
    for (int i = 3; i < 6; ++i) s[i] = m * e[i] + mv * d[i];
    for (int i = 0; i < 3; ++i) {
      const Real p0 = f[3 * i] * s[0] + f[3 * i + 1] * s[3] + f[3 * i + 2] * s[5];
      const Real p1 = f[3 * i] * s[3] + f[3 * i + 1] * s[1] + f[3 * i + 2] * s[4];
      const Real p2 = f[3 * i] * s[5] + f[3 * i + 1] * s[4] + f[3 * i + 2] * s[2];
      for (int k = 0; k < 3; ++k) force[3 * k + i] = p0 * g[3 * k] + p1 * g[3 * k + 1] + p2 * g[3 * k + 2];
    }
  }

 private:
  /// Column a of one matrix times column b of another.
  HOUSE_HOST_DEVICE static inline Real dot(const Real* p, int a, const Real* q, int b) {
    return p[a] * q[b] + p[3 + a] * q[3 + b] + p[6 + a] * q[6 + b];
  }
};

}  // namespace qdem
