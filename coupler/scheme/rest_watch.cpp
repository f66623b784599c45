#include "coupler/scheme/rest_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coupler {

RestWatch::RestWatch(int min_windows, int check_windows, double tolerance, double force_floor)
    : min_windows_(static_cast<std::size_t>(std::max(min_windows, 0))),
      check_windows_(static_cast<std::size_t>(std::max(check_windows, 1))),
      tolerance_(tolerance),
      force_floor_(force_floor),
      change_(std::numeric_limits<double>::infinity()) {}

bool RestWatch::add(const std::vector<double>& seat_force) {
  ++n_windows_;
  history_.push_back(seat_force);
  if (history_.size() <= check_windows_) return false;
  if (history_.size() > check_windows_ + 1) history_.pop_front();
  change_ = 0.0;
  for (std::size_t s = 0; s < seat_force.size(); ++s) {
    double lowest = seat_force[s], highest = seat_force[s];
    for (const auto& forces : history_) {
      lowest = std::min(lowest, forces[s]);
      highest = std::max(highest, forces[s]);
    }
    const double band = highest - lowest, scale = std::max(std::abs(seat_force[s]), force_floor_);
    // A seat that carries nothing at all is at rest; one that swings about nothing is not.
    if (band > 0.0) change_ = std::max(change_, scale > 0.0 ? band / scale : std::numeric_limits<double>::infinity());
  }
  return n_windows_ >= min_windows_ && change_ <= tolerance_;
}

}  // namespace coupler
