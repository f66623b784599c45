// Judges when the coupled system has come to rest in the initialise phase.
#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <string>
#include <vector>

#include "proto/case/coupling.hpp"

namespace coupler {

/// What one window of the initialise phase says about rest.
struct RestSample {
  std::vector<double> seat_force;                  ///< normal force of every seat [N]
  double qdem_residual = 0.0, fem_residual = 0.0;  ///< Result.residual of either side [-]
};

/// How far from rest the system was over the last `check_windows` windows; infinite before as many were seen.
struct RestFigures {
  double change = std::numeric_limits<double>::infinity();         ///< of the seat force, largest of all seats [-]
  double qdem_residual = std::numeric_limits<double>::infinity();  ///< largest [-]
  double fem_residual = std::numeric_limits<double>::infinity();   ///< largest [-]
};

/// Watches the seat forces and both sides' residuals over a number of windows.
class RestWatch {
 public:
  /// Rest is, after at least `min_windows`, over the last `check_windows` windows: the force of every seat stayed
  /// within a band of `tolerance` times the larger of its last value and `force_floor`, and both residuals within their
  /// limits.
  explicit RestWatch(const proto::Initialise& limits) : limits_(limits) {}

  /// Takes one more window. Returns true at rest.
  bool add(RestSample sample);

  const RestFigures& figures() const { return figures_; }

  /// Every criterion in words: its value, and its limit by the name of the case's key.
  std::string text() const;

 private:
  proto::Initialise limits_;
  RestFigures figures_;
  int n_windows_ = 0;
  std::deque<RestSample> history_;
};

}  // namespace coupler
