#include "fem_solver/contact/hertz.hpp"

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace fem {
namespace {

constexpr double pi = 3.14159265358979323846;

// The ellipse's condition B/A = [E a^2/b^2 - K]/[K - E] for e^2 = 1 - b^2/a^2 (std::comp_ellint takes e itself).
double curvature_ratio(double e) {
  const double k = std::comp_ellint_1(e), el = std::comp_ellint_2(e);
  return (el / (1 - e * e) - k) / (k - el);
}

// Below e = 1e-4 the ratio is 1 within 1e-8 and K - E loses its digits.
constexpr double smallest_eccentricity = 1e-4;

double eccentricity(double ratio) {
  double low = smallest_eccentricity, high = 1 - 1e-12;
  if (ratio <= curvature_ratio(low)) return low;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (curvature_ratio(middle) < ratio ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

Hertz::Hertz(double radius_1, double radius_2, const ElasticBody& body_1, const ElasticBody& body_2) {
  if (!(radius_1 > 0 && radius_2 > 0 && body_1.young > 0 && body_2.young > 0))
    throw proto::Error(proto::ExitCode::bad_data, "Hertz contact needs positive radii and moduli", "[wheel]");
  const auto compliance = [](const ElasticBody& b) { return (1 - b.poisson * b.poisson) / b.young; };
  contact_modulus_ = 1 / (compliance(body_1) + compliance(body_2));
  const double first = 1 / (2 * radius_1), second = 1 / (2 * radius_2);
  curvature_ = std::min(first, second);  // A: along the ellipse's long axis
  const double e = eccentricity(std::max(first, second) / curvature_);
  parameter_ = e;
  axis_ratio_ = std::sqrt(1 - e * e);
  coefficient_ = 1.0 / std::pow(at_force(1.0).approach, 1.5);
}

HertzState Hertz::at_force(double force) const {
  const double e = parameter_, k = std::comp_ellint_1(e), el = std::comp_ellint_2(e);
  HertzState s;
  s.semi_axis_long = std::cbrt(3 * force * (k - el) / (2 * pi * contact_modulus_ * e * e * curvature_));
  s.semi_axis_short = s.semi_axis_long * axis_ratio_;
  s.peak_pressure = 3 * force / (2 * pi * s.semi_axis_long * s.semi_axis_short);
  s.approach = 3 * force * k / (2 * pi * contact_modulus_ * s.semi_axis_long);
  s.stiffness = 1.5 * force / s.approach;
  return s;
}

}  // namespace fem
