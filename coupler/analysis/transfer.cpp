#include "coupler/analysis/transfer.hpp"

#include <cmath>
#include <utility>

#include "coupler/analysis/statistics.hpp"

namespace coupler::analysis {

BottomReference::BottomReference(std::vector<SegmentTransforms> cells) : cells_(std::move(cells)) {
  power_.assign(frequency().size(), 0.0);
  for (const auto& cell : cells_) {
    const auto density = power_density(cell);
    for (std::size_t k = 0; k < power_.size(); ++k) power_[k] += density[k] / static_cast<double>(cells_.size());
  }
}

Response BottomReference::response(const SegmentTransforms& stone, std::size_t nearest) const {
  const auto own = power_density(stone), above = power_density(cells_[nearest]);
  const auto cross = cross_density(cells_[nearest], stone);
  Response result;
  for (std::size_t k = 0; k < own.size(); ++k) {
    result.magnitude.push_back(std::sqrt(own[k] / power_[k]));
    result.coherence.push_back(std::norm(cross[k]) / (own[k] * above[k]));
  }
  return result;
}

double band_mean(const std::vector<double>& frequency, const std::vector<double>& values, double low, double high) {
  std::vector<double> inside;
  for (std::size_t k = 0; k < frequency.size(); ++k) {
    if (frequency[k] >= low && frequency[k] <= high) inside.push_back(values[k]);
  }
  return statistics(inside).mean;
}

}  // namespace coupler::analysis
