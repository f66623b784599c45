// A zero-phase low-pass filter for equidistant histories.
#pragma once

#include <cmath>
#include <vector>

namespace tests {

/// Windowed sinc (Blackman) with the given half width; `cutoff` and the interval in matching units [Hz, s]. The first
/// and last `half_width` values see zeros beyond the ends; leave them out.
inline std::vector<double> low_pass(const std::vector<double>& values, double interval, double cutoff, int half_width) {
  constexpr double pi = 3.14159265358979323846;
  std::vector<double> kernel;
  double sum = 0.0;
  for (int i = -half_width; i <= half_width; ++i) {
    const double x = 2 * pi * cutoff * interval * i, t = pi * i / half_width;
    kernel.push_back((i == 0 ? 1.0 : std::sin(x) / x) * (0.42 + 0.5 * std::cos(t) + 0.08 * std::cos(2 * t)));
    sum += kernel.back();
  }
  std::vector<double> smooth(values.size(), 0.0);
  const int n = static_cast<int>(values.size());
  for (int i = 0; i < n; ++i)
    for (int k = -half_width; k <= half_width; ++k)
      if (i + k >= 0 && i + k < n) smooth[i] += kernel[k + half_width] / sum * values[i + k];
  return smooth;
}

inline double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace tests
