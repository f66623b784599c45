// A linear finite-element model of its own, to compare the solver with.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <array>
#include <vector>

#include "qdem_solver/model/model.hpp"

namespace tests {

/// Linear elastic tetrahedra with lumped masses, assembled here from shape functions and Hooke's law in Voigt notation:
/// no code of the solver.
struct LinearFem {
  Eigen::SparseMatrix<double> stiffness;
  Eigen::VectorXd mass;

  LinearFem(const std::vector<Eigen::Vector3d>& nodes, const std::vector<std::array<int, 4>>& tets,
            const qdem::Material& m)
      : stiffness(3 * nodes.size(), 3 * nodes.size()), mass(Eigen::VectorXd::Zero(3 * nodes.size())) {
    Eigen::Matrix<double, 6, 6> hooke = Eigen::Matrix<double, 6, 6>::Zero();
    const double c = m.young / ((1 + m.poisson) * (1 - 2 * m.poisson));
    hooke.topLeftCorner<3, 3>().setConstant(c * m.poisson);
    for (int i = 0; i < 3; ++i) hooke(i, i) = c * (1 - m.poisson), hooke(i + 3, i + 3) = c * (0.5 - m.poisson);
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& tet : tets) {
      Eigen::Matrix4d corners;  // rows 1, x, y, z: its inverse holds the shape functions
      for (int k = 0; k < 4; ++k) corners.row(k) << 1, nodes[tet[k]].transpose();
      const Eigen::Matrix4d shape = corners.inverse();
      const double volume = corners.determinant() / 6;
      Eigen::Matrix<double, 6, 12> b = Eigen::Matrix<double, 6, 12>::Zero();
      for (int k = 0; k < 4; ++k) {
        const double x = shape(1, k), y = shape(2, k), z = shape(3, k);
        b.block<6, 3>(0, 3 * k) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
        for (int i = 0; i < 3; ++i) mass[3 * tet[k] + i] += m.density * volume / 4;
      }
      const Eigen::Matrix<double, 12, 12> local = volume * b.transpose() * hooke * b;
      for (int i = 0; i < 12; ++i) {
        for (int j = 0; j < 12; ++j) {
          entries.emplace_back(3 * tet[i / 3] + i % 3, 3 * tet[j / 3] + j % 3, local(i, j));
        }
      }
    }
    stiffness.setFromTriplets(entries.begin(), entries.end());
  }
};

}  // namespace tests
