#include "qdem_solver/contact/calibration.hpp"

#include <cmath>

namespace qdem {
namespace {

/// Duration of an impact times sqrt(k/m).
double duration(double zeta) {
  const double s = std::sqrt(1 - zeta * zeta);
  return s > 0 ? (M_PI - std::atan2(2 * zeta * s, 1 - 2 * zeta * zeta)) / s : 2.0;
}

}  // namespace

double restitution_of(double damping_ratio) {
  return std::exp(-damping_ratio * duration(damping_ratio));
}

double least_restitution() {
  return restitution_of(1.0);
}

double damping_ratio_for(double restitution) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (restitution_of(middle) > restitution ? low : high) = middle;
  }
  return (low + high) / 2;
}

double stiffness_for(double contact_time, double reduced_mass, double damping_ratio) {
  const double frequency = duration(damping_ratio) / contact_time;
  return reduced_mass * frequency * frequency;
}

double hertz_tangent(double young, double poisson, double radius, double load) {
  const double modulus = young / (2 * (1 - poisson * poisson));
  return std::cbrt(6 * modulus * modulus * radius * load);
}

}  // namespace qdem
