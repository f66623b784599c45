// Stones under and around a sleeper: who lies where, and how their motion falls off.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "proto/span.hpp"

namespace coupler::analysis {

/// The sleeper's bottom, global axes [m].
struct Footprint {
  double x_min = 0.0, x_max = 0.0, y_min = 0.0, y_max = 0.0, z = 0.0;

  /// Horizontal distance from the rectangle, 0 inside [m].
  double beside(const std::array<double, 3>& point) const;
  /// Distance from the rectangle in space [m].
  double distance(const std::array<double, 3>& point) const;
};

/// Evenly sampled motion of many points.
struct Motion {
  double interval = 0.0;                     ///< [s]
  std::vector<double> time;                  ///< [n]
  std::vector<std::array<double, 3>> place;  ///< at time 0 [m]
  std::vector<double> displacement;          ///< [n][points][3] since time 0 [m]
  std::vector<double> velocity;              ///< [n][points][3] [m/s]

  std::size_t n_samples() const { return time.size(); }
  std::size_t n_points() const { return place.size(); }
  /// One component of one point over time, of `values` = displacement or velocity.
  std::vector<double> history(const std::vector<double>& values, std::size_t point, int axis) const;
};

struct DepthBin {
  double top = 0.0, bottom = 0.0;   ///< depth below the sleeper's bottom [m]
  std::vector<std::size_t> points;  ///< those inside
  double middle() const { return 0.5 * (top + bottom); }
};

/// Points below the sleeper's bottom and at most `reach` [m] beside it, in `n_bins` equally thick bins down to the
/// lowest of them. Empty when there is no such point.
std::vector<DepthBin> depth_bins(const std::vector<std::array<double, 3>>& places, const Footprint& footprint,
                                 std::size_t n_bins, double reach);

/// Root mean square of the change of a record about its mean.
double rms(proto::Span<const double> record);
/// Largest magnitude of the change since the first sample.
double peak_change(proto::Span<const double> record);

}  // namespace coupler::analysis
