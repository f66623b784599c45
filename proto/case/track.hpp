// `[track]`: what both solvers have to know of the track.
#pragma once

#include "proto/case/case_file.hpp"

namespace proto {

struct Track {
  double gauge = 0.0;            ///< between the inner faces of the rail heads [m]
  double sleeper_spacing = 0.0;  ///< between sleeper centres, along the track [m]
};

/// Reads `[track]`: gauge_m, sleeper_spacing_m; both required and positive.
Track read_track(const CaseFile& file);

}  // namespace proto
