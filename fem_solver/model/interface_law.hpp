// The law of one component of one pad cell on the FEM side.
#pragma once

#include <vector>

#include "proto/pad/pad_law.hpp"

namespace fem {

/// A pad that may stiffen when pressed, cut off where the clip is used up. `beyond_linear`: only what exceeds its own
/// spring and dashpot, for pads whose linear part is in the track's matrices.
struct InterfaceLaw {
  proto::PadLaw pad;
  double stiffening_begin = 0.0;  ///< compression where the second stiffness begins [m]
  double stiffening = 0.0;        ///< second stiffness minus the first [N/m]
  bool beyond_linear = false;

  /// Force on the sleeper for relative displacement and rate, as proto::PadLaw::force() [N].
  double force(double gap, double rate) const {
    const double full = pad.force(gap, rate) + (pressed_hard(gap) ? stiffening * (gap + stiffening_begin) : 0.0);
    return beyond_linear ? full - pad.stiffness * gap - pad.damping * rate : full;
  }
  /// Derivative when gap and rate change by `gap_factor` and `rate_factor` per unit.
  double tangent(double gap, double rate, double gap_factor, double rate_factor) const {
    const double linear = pad.stiffness * gap_factor + pad.damping * rate_factor;
    const double full = (pad.engaged(gap, rate) ? linear : 0.0) + (pressed_hard(gap) ? stiffening * gap_factor : 0.0);
    return beyond_linear ? full - linear : full;
  }

 private:
  bool pressed_hard(double gap) const { return stiffening > 0.0 && gap < -stiffening_begin; }
};

inline std::vector<InterfaceLaw> interface_laws_of(const std::vector<proto::PadLaw>& pads) {
  std::vector<InterfaceLaw> laws;
  for (const auto& pad : pads) laws.push_back({pad});
  return laws;
}

}  // namespace fem
