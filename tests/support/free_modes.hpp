// Lowest modes of a free body from the test's own linear model: shapes to start the solver's free vibration from.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <random>

#include "tests/support/linear_fem.hpp"
#include "tests/support/vibration.hpp"

namespace tests {

struct Mode {
  double frequency = 0.0;  ///< of the linear model [Hz]
  MotionShape shape;       ///< of largest component one
};

/// Lowest `n` modes above the first `n_rigid` in ascending order, by subspace iteration (Bathe and Wilson 1972).
/// `scale` [Hz]: a frequency of their order, which shifts the operator off its rigid motions.
inline std::vector<Mode> lowest_modes(const LinearFem& fem, int n_rigid, int n, double scale) {
  const double shift = 0.1 * std::pow(2 * M_PI * scale, 2);
  Eigen::SparseMatrix<double> shifted = fem.stiffness;
  for (Eigen::Index i = 0; i < fem.mass.size(); ++i) shifted.coeffRef(i, i) += shift * fem.mass[i];
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> solver(shifted);

  std::mt19937_64 random(7);
  Eigen::MatrixXd x(fem.mass.size(), n + n_rigid + 10);
  for (double& value : x.reshaped()) value = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  Eigen::VectorXd eigenvalues = Eigen::VectorXd::Zero(x.cols()), before = eigenvalues;
  for (int iteration = 0; iteration < 60; ++iteration) {
    x = solver.solve(fem.mass.asDiagonal() * x).eval();
    for (auto column : x.colwise()) column.normalize();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(x.transpose() * (fem.stiffness * x),
                                                                         x.transpose() * fem.mass.asDiagonal() * x);
    x = (x * ritz.eigenvectors()).eval();
    before = eigenvalues, eigenvalues = ritz.eigenvalues();
    if ((eigenvalues - before).segment(n_rigid, n).norm() < 1e-9 * eigenvalues.segment(n_rigid, n).norm()) break;
  }

  std::vector<Mode> modes(n);
  for (int m = 0; m < n; ++m) {
    modes[m].frequency = std::sqrt(eigenvalues[n_rigid + m]) / (2 * M_PI);
    const double largest = x.col(n_rigid + m).lpNorm<Eigen::Infinity>();
    for (int i = 0; 3 * i < fem.mass.size(); ++i)
      modes[m].shape.push_back(x.col(n_rigid + m).segment<3>(3 * i) / largest);
  }
  return modes;
}

/// Lowest `n` elastic modes of a free body. `scale`: as above.
inline std::vector<Mode> free_modes(const qdem::Template& body, const qdem::Material& material, int n, double scale) {
  return lowest_modes(LinearFem(body.nodes, body.tets, material), 6, n, scale);
}

}  // namespace tests
