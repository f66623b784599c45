// Closed forms of the thin annular disc that is held at its inner edge, plane stress, written independently of the
// solver.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace tests {

struct Annulus {
  double inner, outer;  ///< [m]
  double young, poisson, density;
};

/// Value and first two derivatives of J_n(k r) (kind 0) or Y_n(k r) (kind 1) over r.
inline Eigen::Vector3d bessel(int kind, int n, double k, double r) {
  const auto f = [&](int order) {
    const double sign = order < 0 && order % 2 != 0 ? -1.0 : 1.0;
    const double m = std::abs(order);
    return sign * (kind == 0 ? std::cyl_bessel_j(m, k * r) : std::cyl_neumann(m, k * r));
  };
  const double value = f(n), slope = k * (f(n - 1) - f(n + 1)) / 2;
  return {value, slope, -slope / r - (k * k - n * n / (r * r)) * value};
}

/// Radial and tangential displacement and stress at r for the four potentials of n nodal diameters (Love, Mathematical
/// Theory of Elasticity, art. 314: u_r = phi' + n psi/r, u_t = -n phi/r - psi').
inline Eigen::Matrix4d annulus_fields(const Annulus& a, int n, double omega, double r) {
  const double plane = a.young / (1 - a.poisson * a.poisson), shear = a.young / (2 * (1 + a.poisson));
  Eigen::Matrix4d fields;
  for (int column = 0; column < 4; ++column) {
    const bool dilatation = column < 2;
    const auto f = bessel(column % 2, n, omega * std::sqrt(a.density / (dilatation ? plane : shear)), r);
    const double u = dilatation ? f[1] : n * f[0] / r, du = dilatation ? f[2] : n * (f[1] - f[0] / r) / r;
    const double v = dilatation ? -n * f[0] / r : -f[1], dv = dilatation ? -n * (f[1] - f[0] / r) / r : -f[2];
    fields.col(column) << u, v, plane * (du + a.poisson * (u + n * v) / r), shear * (-n * u / r + dv - v / r);
  }
  return fields;
}

/// Frequencies [Hz] up to `highest` with n nodal diameters; the inner edge held, or free when `free_inside`. For n = 0
/// the radial ones.
inline std::vector<double> annulus_frequencies(const Annulus& a, int n, double highest, bool free_inside = false) {
  const double full_turn = 2 * std::acos(-1.0);
  const auto condition = [&](double f) {
    const Eigen::Matrix4d in = annulus_fields(a, n, full_turn * f, a.inner);
    const Eigen::Matrix4d out = annulus_fields(a, n, full_turn * f, a.outer);
    const int row = free_inside ? 2 : 0;
    if (n == 0) return in(row, 0) * out(2, 1) - in(row, 1) * out(2, 0);
    Eigen::Matrix4d both;
    both << in.middleRows<2>(row), out.bottomRows<2>();
    for (int i = 0; i < 4; ++i) both.col(i).normalize();
    return both.determinant();
  };
  std::vector<double> found;
  const double step = highest / 4000;
  for (double f = highest / 20; f < highest; f += step) {
    double low = f, high = f + step;
    if (condition(low) * condition(high) > 0) continue;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (condition(low) * condition(middle) > 0 ? low : high) = middle;
    }
    found.push_back(low);
  }
  return found;
}

/// Mean radial displacement of the arc of half angle `arc` on the outer edge per total radial force that is spread
/// evenly over it [m/N]; the disc is `thickness` thick, its inner edge held. Fourier series of Michell's solutions u_r
/// = a r^l cos n t, u_t = b r^l sin n t.
inline double annulus_flexibility(const Annulus& d, double thickness, double arc) {
  const double plane = d.young / (1 - d.poisson * d.poisson), shear = d.young / (2 * (1 + d.poisson));
  const double pi = std::acos(-1.0), pressure = 1 / (2 * arc * d.outer * thickness);
  double sum = 0.0;
  for (int harmonic = 0; harmonic < 400; ++harmonic) {
    // A whole 1 makes two exponents equal; a hair beside it they are not.
    const double n = harmonic == 1 ? 1 + 1e-5 : harmonic;
    const double exponents[4] = {n - 1, n + 1, -n - 1, 1 - n};
    const int size = harmonic == 0 ? 2 : 4;
    Eigen::MatrixXd conditions(size, size);
    Eigen::VectorXd outer(size);
    for (int k = 0; k < size; ++k) {
      const double l = harmonic == 0 ? (k == 0 ? 1.0 : -1.0) : exponents[k];
      const auto stress = [&](double a, double b) {  // radial, hoop, shear, times r^(1 - l)
        return Eigen::Vector3d(plane * (a * l + d.poisson * (a + n * b)), plane * (a + n * b + d.poisson * a * l),
                               shear * (-n * a + (l - 1) * b));
      };
      // Radial equilibrium l s_r - s_t + n t = 0 gives b for a = 1.
      const auto balance = [&](const Eigen::Vector3d& s) { return l * s[0] - s[1] + n * s[2]; };
      const double b = harmonic == 0 ? 0.0 : -balance(stress(1, 0)) / balance(stress(0, 1));
      // Scaled so that no power over- or underflows.
      const double at_inner = l > 0 ? std::pow(d.inner / d.outer, l) : 1.0;
      const double at_outer = l > 0 ? 1.0 : std::pow(d.outer / d.inner, l);
      const Eigen::Vector3d s = stress(1, b) * at_outer / d.outer;
      outer[k] = at_outer;
      if (harmonic == 0) {
        conditions.col(k) << at_inner, s[0];
      } else {
        conditions.col(k) << at_inner, b * at_inner, s[0] / plane, s[2] / plane;
      }
    }
    const double load = harmonic == 0 ? pressure * arc / pi : 2 * pressure * std::sin(n * arc) / (n * pi);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    right[harmonic == 0 ? 1 : 2] = harmonic == 0 ? -load : -load / plane;
    const double displacement = -outer.dot(conditions.fullPivLu().solve(right));
    sum += displacement * (harmonic == 0 ? 1.0 : std::sin(n * arc) / (n * arc));
  }
  return sum;
}

}  // namespace tests
