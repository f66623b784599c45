// Means, spreads, and lines through points.
#pragma once

#include <cstddef>
#include <vector>

#include "proto/span.hpp"

namespace coupler::analysis {

struct Statistics {
  std::size_t n = 0;
  double mean = 0.0;       ///< NaN where n = 0
  double deviation = 0.0;  ///< sample standard deviation; NaN where n < 2
  double largest = 0.0;    ///< NaN where n = 0
};

Statistics statistics(proto::Span<const double> values);

/// Least-squares line y = offset + slope x. Pre: at least two different x.
struct Line {
  double offset = 0.0, slope = 0.0;
};
Line fitted_line(proto::Span<const double> x, proto::Span<const double> y);

/// Length L [unit of x] over which positive values fall by 1/e, from the line through their logarithms; NaN where fewer
/// than two values are positive or they do not fall.
double decay_length(proto::Span<const double> x, proto::Span<const double> values);

/// Position of x in evenly spaced bins between `low` and `high`; values outside go to the first and last bin.
std::size_t bin_of(double x, double low, double high, std::size_t n_bins);

}  // namespace coupler::analysis
