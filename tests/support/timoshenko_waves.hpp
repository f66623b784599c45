// Closed forms of the uniform Timoshenko beam, written independently of the solver.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

namespace tests {

struct UniformBeam {
  double bending;         ///< E I [N m2]
  double shear;           ///< kappa G A [N]
  double mass;            ///< rho A [kg/m]
  double rotary_inertia;  ///< rho I [kg m]
};

constexpr double two_pi = 6.283185307179586;

/// Lowest frequency [Hz] with n half waves between hinges `length` apart: the smaller root of the biquadratic
/// rho I m/(kappa G A) w^4 - (m + rho I b^2 + m E I b^2/(kappa G A)) w^2 + E I b^4 = 0, b = n pi/L.
inline double hinged_frequency(const UniformBeam& beam, double length, int n = 1) {
  const double b2 = std::pow(n * two_pi / 2 / length, 2);
  const double a = beam.rotary_inertia * beam.mass / beam.shear;
  const double middle = beam.mass + beam.rotary_inertia * b2 + beam.mass * beam.bending * b2 / beam.shear;
  const double squared =
      2 * beam.bending * b2 * b2 / (middle + std::sqrt(middle * middle - 4 * a * beam.bending * b2 * b2));
  return std::sqrt(squared) / two_pi;
}

/// Frequencies [Hz] of the free beam up to `highest`, rigid motions left out. Deflection, rotation, moment and shear
/// force, made dimensionless by length and bending stiffness, are carried from end to end by the matrix exponential;
/// moment and force must vanish at both.
inline std::vector<double> free_frequencies(const UniformBeam& beam, double length, double highest) {
  const auto end_forces = [&](double f) {
    const double w2 = std::pow(two_pi * f, 2), l2 = length * length;
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a(0, 1) = a(1, 2) = 1, a(0, 3) = beam.bending / (beam.shear * l2);
    a(2, 1) = -beam.rotary_inertia * w2 * l2 / beam.bending, a(2, 3) = -1;
    a(3, 0) = -beam.mass * w2 * l2 * l2 / beam.bending;
    const Eigen::Matrix4d carried = a.exp();
    return carried.block<2, 2>(2, 0).determinant();
  };
  std::vector<double> found;
  const double step = 1.0;
  for (double f = 10.0; f < highest; f += step) {
    double low = f, high = f + step;
    if (end_forces(low) * end_forces(high) > 0) continue;
    for (int i = 0; i < 50; ++i) {
      const double middle = (low + high) / 2;
      (end_forces(low) * end_forces(middle) > 0 ? low : high) = middle;
    }
    found.push_back(low);
  }
  return found;
}

/// Steady deflection at the distance `ahead` before a force that moves at `speed` over the beam on a foundation of
/// `stiffness` [N/m2] and `damping` [N s/m2] per length: Fourier integral over the wave number, whose tail under the
/// force is added in closed form. Below the critical speed.
inline double moving_load_deflection(const UniformBeam& beam, double stiffness, double damping, double force,
                                     double speed, double ahead) {
  constexpr double highest = 400.0, step = 2e-3;  // [1/m]
  const double moving_shear = beam.shear - beam.mass * speed * speed;
  double sum = 0.0;
  for (double k = step / 2; k < highest; k += step) {
    const double q = k * k, turning = beam.bending * q + beam.shear - beam.rotary_inertia * speed * speed * q;
    const std::complex<double> d(stiffness + moving_shear * q - beam.shear * beam.shear * q / turning,
                                 -damping * speed * k);
    sum += 2 * step * (std::polar(1.0, k * ahead) / d).real();
  }
  const double tail = ahead == 0.0 ? 2 / (moving_shear * highest) : 0.0;
  return force / two_pi * (sum + tail);
}

}  // namespace tests
