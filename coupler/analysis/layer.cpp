#include "coupler/analysis/layer.hpp"

#include <algorithm>
#include <cmath>

#include "coupler/analysis/statistics.hpp"

namespace coupler::analysis {

double Footprint::beside(const std::array<double, 3>& point) const {
  const double dx = std::max({x_min - point[0], 0.0, point[0] - x_max});
  const double dy = std::max({y_min - point[1], 0.0, point[1] - y_max});
  return std::hypot(dx, dy);
}

double Footprint::distance(const std::array<double, 3>& point) const {
  return std::hypot(beside(point), point[2] - z);
}

std::vector<double> Motion::history(const std::vector<double>& values, std::size_t point, int axis) const {
  std::vector<double> result(n_samples());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = values[3 * (i * n_points() + point) + static_cast<std::size_t>(axis)];
  }
  return result;
}

std::vector<DepthBin> depth_bins(const std::vector<std::array<double, 3>>& places, const Footprint& footprint,
                                 std::size_t n_bins, double reach) {
  std::vector<std::size_t> below;
  double lowest = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double depth = footprint.z - places[i][2];
    if (!(depth > 0) || footprint.beside(places[i]) > reach) continue;
    below.push_back(i);
    lowest = std::max(lowest, depth);
  }
  if (below.empty()) return {};
  std::vector<DepthBin> bins(n_bins);
  for (std::size_t b = 0; b < n_bins; ++b) {
    bins[b].top = lowest * static_cast<double>(b) / static_cast<double>(n_bins);
    bins[b].bottom = lowest * static_cast<double>(b + 1) / static_cast<double>(n_bins);
  }
  for (const std::size_t i : below) bins[bin_of(footprint.z - places[i][2], 0.0, lowest, n_bins)].points.push_back(i);
  return bins;
}

double rms(proto::Span<const double> record) {
  const double mean = statistics(record).mean;
  double sum = 0.0;
  for (const double value : record) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(record.size()));
}

double peak_change(proto::Span<const double> record) {
  double largest = 0.0;
  for (const double value : record) largest = std::max(largest, std::abs(value - record[0]));
  return largest;
}

}  // namespace coupler::analysis
