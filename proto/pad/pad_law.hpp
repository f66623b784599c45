// The rail pad: spring and dashpot per component between the rail foot and the sleeper, with the clip's preload.
#pragma once

#include "proto/span.hpp"

namespace proto {

/// Law of one component of one pad cell, the same on both sides of the interface.
///
///     f = k (u - x) + c (u' - x')        force on the sleeper [N]; the rail feels -f
///
/// u: rail foot, x: sleeper, both in seat axes at the cell's point. The third seat axis points from sleeper to rail, so
/// a pressed pad has f < 0 along it. With the tension cut-off the pad leaves the rail once the clip's preload P is used
/// up and only the clip still pulls: f = min(f, P). Source: formulation of this project.
struct PadLaw {
  double stiffness = 0.0;  ///< [N/m]
  double damping = 0.0;    ///< [N s/m]
  double preload = 0.0;    ///< clip force carried by this cell [N], used with the cut-off
  bool tension_cutoff = false;

  /// Force on the sleeper for relative displacement `gap` = u - x [m] and its rate [m/s].
  HOUSE_HOST_DEVICE double force(double gap, double gap_rate) const {
    const double linear = stiffness * gap + damping * gap_rate;
    return tension_cutoff && linear > preload ? preload : linear;
  }
  /// True while the spring and the dashpot act, false when only the clip pulls.
  HOUSE_HOST_DEVICE bool engaged(double gap, double gap_rate) const {
    return !tension_cutoff || stiffness * gap + damping * gap_rate <= preload;
  }
};

}  // namespace proto
