#include "coupler/analysis/cycles.hpp"

#include <algorithm>
#include <cmath>

namespace coupler::analysis {
namespace {

constexpr double dead_share = 0.2;  // of the range, on either side of the middle

}  // namespace

std::vector<Cycle> load_cycles(proto::Span<const double> load) {
  std::vector<Cycle> cycles;
  if (load.size() == 0) return cycles;
  const auto [least, most] = std::minmax_element(load.begin(), load.end());
  const double range = *most - *least, middle = 0.5 * (*most + *least);
  if (!(range > 0.0) || !std::isfinite(range)) return cycles;
  bool high = false, low = false;  // of the cycle that is open: it has been high; it has come down
  for (std::size_t i = 0; i < load.size(); ++i) {
    if (load[i] > middle + dead_share * range) {
      if (!high || low) cycles.push_back({i, i});
      high = true, low = false;
      if (load[i] > load[cycles.back().peak]) cycles.back().peak = i;
    } else if (high && load[i] < middle - dead_share * range) {
      if (!low || load[i] < load[cycles.back().trough]) cycles.back().trough = i;
      low = true;
    }
  }
  if (high && !low) cycles.pop_back();
  return cycles;
}

}  // namespace coupler::analysis
