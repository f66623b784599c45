// What the suite plays to a participant in the place of the other side.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/case/rail_seat.hpp"
#include "proto/pad/pad_law.hpp"
#include "proto/wire/messages.hpp"

namespace coupler::conformance {

/// All cells move alike, along the three seat axes, from where the participant stands at Start: up and down by the
/// amplitude once in 16 windows, p(t) = p_0 + a d (1 - cos(2 pi t / 16 H)) / 2.
class Motion {
 public:
  /// `start`: displacement of every interface value at time 0 [m].
  Motion(std::vector<double> start, std::vector<proto::PadLaw> laws, double window_s, double amplitude_m);

  /// The rail's straight path through window `n`, for qdem. `scale` multiplies the amplitude.
  proto::FieldSet rail(std::int64_t n, double scale) const;
  /// A rail that stands, pressed down by the amplitude.
  proto::FieldSet standing_rail() const;
  /// The predicted sleeper and a constant carry, for fem in the mode robin.
  proto::FieldSet sleeper(std::int64_t n, double scale) const;
  /// The force that the pad would give against a standing rail, for fem in the mode prescribed_force.
  proto::FieldSet force(std::int64_t n, double scale) const;

 private:
  std::vector<double> displacement(double windows, double scale) const;
  std::vector<double> velocity(double windows, double scale) const;

  std::vector<double> start_;
  std::vector<proto::PadLaw> laws_;
  double window_s_, amplitude_m_;
};

}  // namespace coupler::conformance
