// How long a window may be: figures of a scheme on one lumped seat, before any run.
#pragma once

#include <cstdint>
#include <limits>

#include "coupler/advisor/lumped_track.hpp"
#include "proto/case/coupling.hpp"

namespace coupler {

/// Factor by which a plain iteration between the sides contracts, rho = k H^2/(4 m) + c H/(2 m), m: the rail's mass at
/// the seat; above 1 it diverges. Formulation of this project.
double fixed_point_factor(const LumpedTrack& track, double window_s);

/// Window at which that factor is 1 [s].
double fixed_point_window(const LumpedTrack& track);

/// Window below which the lagging dashpot of E0 and E1 does not outweigh the pad's own: 0.8 c/k [s]; infinite without a
/// spring. A lower bound, measured on lumped seats. Formulation of this project.
double lag_window(const LumpedTrack& track);

/// How the scan of critical_window() is done.
struct StabilityScan {
  int n_windows = 120;     ///< of each trial; growth is seen over the second half
  double growth = 1e-4;    ///< per window; less counts as stable
  double shortest = 1e-2;  ///< first window over 1/omega, omega: of the pad between the two masses
  double longest = 30.0;   ///< last one
};

/// Factor per window by which the motion of `scheme`, all else as `coupling` says, on `track` grows in `n_windows`
/// windows of `window_s` [s], over the second half; infinite when it overflows. Only schemes with a pad.
double growth_per_window(proto::Scheme scheme, const proto::Coupling& coupling, const LumpedTrack& track,
                         double window_s, int n_windows);

/// Longest window [s] up to which `scheme` does not grow on `track`: the scheme itself is run on it with ever longer
/// windows. 0 when it grows from the shortest on; infinite when none grew. Only schemes with a pad.
double critical_window(proto::Scheme scheme, const proto::Coupling& coupling, const LumpedTrack& track,
                       const StabilityScan& scan = {});

}  // namespace coupler
