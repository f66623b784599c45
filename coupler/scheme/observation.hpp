// What a run showed of its scheme: passes, contraction, growth, and whether the rail's side has the pad's law.
#pragma once

#include <cstdint>
#include <string>

#include "coupler/scheme/window_record.hpp"
#include "proto/result/state_archive.hpp"

namespace coupler {

/// Sums over the windows of the march.
struct ObservationState {
  std::int64_t n_windows = 0, n_solves = 0, n_unconverged = 0, n_contractions = 0;
  int most_solves = 0;
  double log_contraction = 0.0;                   ///< sum of log of WindowRecord::contraction
  double defect_before = 0.0, defect_last = 0.0;  ///< sums of |H f_used - I|^2: third and last quarter of the run
  double impulse = 0.0;                           ///< sum of |I|^2
  double law_deviation = 0.0, law_force = 0.0;    ///< sums of squares: Robin force minus the law's; the law's
};

/// Takes every window of a march of `n_windows`.
class Observation {
 public:
  Observation(std::int64_t n_windows, double window_s) : n_windows_(n_windows), window_s_(window_s) {}

  void add(const WindowRecord& record);

  double mean_solves() const;  ///< of the sleeper's side, per window
  /// Geometric mean of the residual's last reduction in an iteration or by a corrector; 0 where there was none.
  double contraction() const;
  /// Factor per window by which the momentum defect grew from the third to the last quarter of the run; 1: not at all,
  /// or the defect is round-off, or the run too short to tell.
  double growth() const;
  /// Relative difference of the rail side's pad force from the registered law at the same motion: that of the tangents.
  double law_deviation() const;
  const ObservationState& state() const { return state_; }
  /// The sums.
  void exchange(proto::StateArchive& archive);

  /// One line for people.
  std::string text() const;

 private:
  std::int64_t n_windows_;
  double window_s_;
  ObservationState state_;
};

}  // namespace coupler
