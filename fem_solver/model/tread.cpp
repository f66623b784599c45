#include "fem_solver/model/tread.hpp"

#include <algorithm>
#include <cmath>

namespace fem {
namespace {

// Millimetres. Sections of the standard: A a line, B and C polynomials of s (rising powers), D to H arcs and a line.
constexpr double end_of_a = 32.15796, end_of_b = -26.0, end_of_c = -35.0, end_of_d = -38.426669071,
                 end_of_e = -39.764473993, end_of_f = -49.662510381, end_of_g = -62.764705882;
constexpr double section_b[] = {0.0,
                                -3.358537058e-02,
                                1.565681624e-03,
                                -2.810427944e-05,
                                5.844240864e-08,
                                -1.562379023e-08,
                                5.309217349e-15,
                                -5.957839843e-12,
                                2.646656573e-13};
constexpr double section_c[] = {-4.320221063e+03, -1.038384026e+03, -1.065501873e+02, -6.051367875,
                                -2.054332446e-01, -4.169739389e-03, -4.687195829e-05, -2.252755540e-07};

template <std::size_t n>
double polynomial(const double (&coefficients)[n], double s) {
  double value = 0.0;
  for (std::size_t k = n; k-- > 0;) value = value * s + coefficients[k];
  return value;
}

double upper_arc(double height, double radius, double centre, double s) {
  return height + std::sqrt(std::max(0.0, radius * radius - (s + centre) * (s + centre)));
}

double s1002(double s) {
  if (s >= end_of_a) return 1.364323640 - 0.066666667 * s;
  if (s >= end_of_b) return polynomial(section_b, s);
  if (s >= end_of_c) return polynomial(section_c, s);
  if (s >= end_of_d) return 16.446 - std::sqrt(13.0 * 13.0 - (s + 26.210665) * (s + 26.210665));
  if (s >= end_of_e) return -93.576667419 - 2.747477419 * s;
  if (s >= end_of_f) return upper_arc(8.834924130, 20.0, 58.558326413, s);
  if (s >= end_of_g) return upper_arc(16.0, 12.0, 55.0, s);
  return upper_arc(9.519259302, 20.5, 49.5, s);
}

double cone(double slope, double s) {
  if (s >= end_of_b) return -slope * s;
  if (s <= end_of_d) return s1002(s);
  const double low = -slope * end_of_b, high = s1002(end_of_d);
  return low + (high - low) * (s - end_of_b) / (end_of_d - end_of_b);
}

}  // namespace

double tread_height(TreadKind kind, double s) {
  switch (kind) {
    case TreadKind::s1002:
      return 1e-3 * s1002(1e3 * s);
    case TreadKind::cone_1_20:
      return 1e-3 * cone(1.0 / 20, 1e3 * s);
    case TreadKind::cone_1_40:
      return 1e-3 * cone(1.0 / 40, 1e3 * s);
  }
  return 0.0;
}

double tread_curvature(TreadKind kind, double s) {
  constexpr double step = 1e-4;  // the sections are smooth on this scale, and rounding stays below 1e-6 per metre
  return (tread_height(kind, s + step) - 2 * tread_height(kind, s) + tread_height(kind, s - step)) / (step * step);
}

}  // namespace fem
