#include "coupler/analysis/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace coupler::analysis {

Statistics statistics(proto::Span<const double> values) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Statistics result{values.size(), none, none, none};
  if (result.n == 0) return result;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(result.n);
  result.largest = *std::max_element(values.begin(), values.end());
  if (result.n < 2) return result;
  double sum = 0.0;
  for (const double value : values) sum += (value - result.mean) * (value - result.mean);
  result.deviation = std::sqrt(sum / static_cast<double>(result.n - 1));
  return result;
}

Line fitted_line(proto::Span<const double> x, proto::Span<const double> y) {
  const double mean_x = statistics(x).mean, mean_y = statistics(y).mean;
  double xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return {mean_y - xy / xx * mean_x, xy / xx};
}

double decay_length(proto::Span<const double> x, proto::Span<const double> values) {
  std::vector<double> at, logarithm;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (values[i] > 0) at.push_back(x[i]), logarithm.push_back(std::log(values[i]));
  }
  if (at.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const double slope = fitted_line(at, logarithm).slope;
  return slope < 0 ? -1 / slope : std::numeric_limits<double>::quiet_NaN();
}

std::size_t bin_of(double x, double low, double high, std::size_t n_bins) {
  const double place = std::floor((x - low) / (high - low) * static_cast<double>(n_bins));
  return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(n_bins - 1)));
}

}  // namespace coupler::analysis
