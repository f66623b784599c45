// Elastic energy and Cauchy stress of one quadruple, for reports and output.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "qdem_solver/physics/quadruple_force.hpp"

namespace qdem {

/// Deformation of one quadruple of a body of scale s: F = (1/s) sum x_k (x) g_k.
/// dx: positions of particles 2, 3, 4 relative to particle 1 (columns), g: rows of the template's Dm^-1.
inline Eigen::Matrix3d deformation_gradient(const Eigen::Matrix3d& dx, const Eigen::Matrix3d& g, double scale) {
  return dx * g / scale;
}

/// Strain energy per reference volume of the St Venant-Kirchhoff solid [J/m3].
inline double energy_density(const Eigen::Matrix3d& f, const QuadrupleMaterial& material) {
  const Eigen::Matrix3d e = 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
  return 0.5 * material.lambda * e.trace() * e.trace() + material.mu * e.squaredNorm();
}

/// Cauchy stress F S F^T / det F of the viscoelastic solid; f_rate: rate of F [Pa].
inline Eigen::Matrix3d cauchy_stress(const Eigen::Matrix3d& f, const Eigen::Matrix3d& f_rate,
                                     const QuadrupleMaterial& material) {
  const Eigen::Matrix3d e = 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d half = f.transpose() * f_rate;
  const Eigen::Matrix3d d = 0.5 * (half + half.transpose());
  const Eigen::Matrix3d s =
      (material.lambda * e.trace() + material.lame_viscosity * d.trace()) * Eigen::Matrix3d::Identity() +
      2 * material.mu * e + 2 * material.shear_viscosity * d;
  return f * s * f.transpose() / f.determinant();
}

}  // namespace qdem
