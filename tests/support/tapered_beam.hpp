// A free Timoshenko beam whose section varies along its length, written independently of the solver: the oracle for a
// tapered sleeper.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <functional>

namespace tests {

/// A trapezoid's section values.
struct BeamSection {
  double area;           ///< [m2]
  double second_moment;  ///< about the horizontal axis through the centroid [m4]

  static BeamSection trapezoid(double height, double bottom, double top) {
    const double sum = bottom + top;
    return {height * sum / 2, std::pow(height, 3) * (sum * sum + 2 * bottom * top) / (36 * sum)};
  }
};

struct BeamSolid {
  double young, poisson, density;
};

/// Bending frequency [Hz] number `mode`, from 1, of the free beam [0, length]: two-node elements with the
/// shear-flexible cubic (Przemieniecki), the section of their middle, lumped mass and rotary inertia. Shear coefficient
/// of a rectangle (Cowper 1966). That the centroid's line is not quite straight is left out.
inline double free_bending(const std::function<BeamSection(double)>& section, double length, const BeamSolid& solid,
                           int mode = 1, int n_elements = 200) {
  const double l = length / n_elements, kappa = 10 * (1 + solid.poisson) / (12 + 11 * solid.poisson);
  const int n = 2 * (n_elements + 1);
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(n);
  for (int e = 0; e < n_elements; ++e) {
    const BeamSection s = section((e + 0.5) * l);
    const double bending = solid.young * s.second_moment,
                 shear = kappa * solid.young / (2 * (1 + solid.poisson)) * s.area;
    const double phi = 12 * bending / (shear * l * l);
    Eigen::Matrix4d k;
    k << 12, 6 * l, -12, 6 * l, 6 * l, (4 + phi) * l * l, -6 * l, (2 - phi) * l * l, -12, -6 * l, 12, -6 * l, 6 * l,
        (2 - phi) * l * l, -6 * l, (4 + phi) * l * l;
    stiffness.block<4, 4>(2 * e, 2 * e) += bending / (l * l * l * (1 + phi)) * k;
    for (int end = 0; end < 2; ++end) {
      mass[2 * (e + end)] += solid.density * s.area * l / 2;
      mass[2 * (e + end) + 1] += solid.density * s.second_moment * l / 2;
    }
  }
  const Eigen::VectorXd root = mass.cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(root.asDiagonal() * stiffness * root.asDiagonal(),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues()[1 + mode]) / (2 * M_PI);  // after two rigid motions
}

}  // namespace tests
