// Where a run's time went: computing against waiting, window by window.
#pragma once

#include <string>
#include <vector>

namespace coupler {

/// One window by the coupler's clock.
struct WindowTimes {
  double begin = 0.0, end = 0.0;  ///< first request, last result; since the march began, anew in a resumed run [s]
  double qdem = 0.0, fem = 0.0;   ///< computing, as the participants report it [s]
};

/// Sums over the windows; a participant that does not compute waits.
struct Profile {
  std::size_t n_windows = 0;
  double wall = 0.0;  ///< from window to window [s]
  double qdem_compute = 0.0, fem_compute = 0.0;
  double between = 0.0;    ///< from a window's end to the next one's begin: commit, record, output [s]
  double transport = 0.0;  ///< within windows, while nobody computes [s]
  double transport_median = 0.0, transport_least = 0.0;  ///< of a window [s]
};

/// `at_once`: both sides compute at the same time (E0), else one after the other.
Profile profile_of(const std::vector<WindowTimes>& windows, bool at_once);

/// For people; ends with a newline.
std::string profile_table(const Profile& profile);

/// The same times as a trace that Perfetto and chrome://tracing show: one track for each participant and one for the
/// windows. Of a window only the sums are known: fem's computing is drawn from its begin, qdem's up to its end.
std::string trace_json(const std::vector<WindowTimes>& windows);

}  // namespace coupler
