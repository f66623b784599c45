// Cycles of a repeated load.
#pragma once

#include <cstddef>
#include <vector>

#include "proto/span.hpp"

namespace coupler::analysis {

/// The load rises above its middle, and falls below it again. Indices into the record.
struct Cycle {
  std::size_t peak = 0;    ///< largest load of the cycle
  std::size_t trough = 0;  ///< least load after the peak, before the next cycle
};

/// The cycles of a load between its least and its largest value. It is high above the middle by a fifth of the range,
/// low below it by as much: ripples between the two are no cycles. A last cycle that does not come down does not count.
/// None for a record that is constant or not finite.
std::vector<Cycle> load_cycles(proto::Span<const double> load);

}  // namespace coupler::analysis
