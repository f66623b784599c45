// Judges when the coupled system has come to rest in the initialise phase.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

namespace coupler {

/// Watches the normal force of every seat over a number of windows.
class RestWatch {
 public:
  /// Rest is: over the last `check_windows` windows, and after at least `min_windows`, the force of every seat stayed
  /// within a band of `tolerance` times the larger of its last value and `force_floor` [N].
  RestWatch(int min_windows, int check_windows, double tolerance, double force_floor = 0.0);

  /// Normal force of every seat in one more window [N]. Returns true at rest.
  bool add(const std::vector<double>& seat_force);

  /// Largest relative width of the band found at the last window; infinite before `check_windows` windows were seen.
  double change() const { return change_; }

 private:
  std::size_t min_windows_, check_windows_, n_windows_ = 0;
  double tolerance_, force_floor_, change_;
  std::deque<std::vector<double>> history_;
};

}  // namespace coupler
