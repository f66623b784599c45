// A Timoshenko beam on springs, written independently of the solver: the oracle for the rail's deflection.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace tests {

/// Static deflection of a beam on discrete pads under point forces. Two-node elements with the exact shear-flexible
/// cubic (Przemieniecki), so that nodal values are exact for nodal loads.
class TimoshenkoBeam {
 public:
  TimoshenkoBeam(double first_x, double last_x, int n_elements, double bending_stiffness, double shear_stiffness)
      : first_(first_x), length_((last_x - first_x) / n_elements), n_(n_elements + 1) {
    matrix_ = Eigen::MatrixXd::Zero(2 * n_, 2 * n_);
    const double l = length_, phi = 12 * bending_stiffness / (shear_stiffness * l * l);
    const double f = bending_stiffness / (l * l * l * (1 + phi));
    Eigen::Matrix4d k;
    k << 12, 6 * l, -12, 6 * l, 6 * l, (4 + phi) * l * l, -6 * l, (2 - phi) * l * l, -12, -6 * l, 12, -6 * l, 6 * l,
        (2 - phi) * l * l, -6 * l, (4 + phi) * l * l;
    for (int e = 0; e < n_elements; ++e) matrix_.block<4, 4>(2 * e, 2 * e) += f * k;
  }

  /// A pad as springs at `places`, `stiffness` each, on one sleeper that translates on `ballast`; the sleeper is
  /// condensed.
  void add_pad(const std::vector<double>& places, double stiffness, double ballast) {
    const double coupling = stiffness * stiffness / (stiffness * places.size() + ballast);
    for (const double a : places)
      for (const double b : places) matrix_(2 * node(a), 2 * node(b)) += (a == b ? stiffness : 0.0) - coupling;
  }

  /// Deflection at every node under `force` at x; positive force gives positive deflection.
  Eigen::VectorXd deflection(double x, double force) const {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(2 * n_);
    load[2 * node(x)] = force;
    const Eigen::VectorXd u = matrix_.ldlt().solve(load);
    return Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<2>>(u.data(), n_);
  }

  int node(double x) const { return static_cast<int>(std::lround((x - first_) / length_)); }

 private:
  double first_, length_;
  int n_;
  Eigen::MatrixXd matrix_;
};

}  // namespace tests
