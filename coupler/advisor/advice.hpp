// What the advisor says about a case before its first window.
#pragma once

#include <string>
#include <vector>

#include "coupler/advisor/lumped_track.hpp"
#include "proto/case/coupling.hpp"
#include "proto/case/rail_seat.hpp"

namespace coupler {

/// A seat along one axis, lumped.
struct SeatAxis {
  std::string name;  ///< "seat 'a', normal"
  LumpedTrack track;
};

/// Every seat and axis with a pad. `laws`: of all interface values; masses that move with one seat [kg].
std::vector<SeatAxis> lumped_seats(const std::vector<proto::RailSeat>& seats, const std::vector<proto::PadLaw>& laws,
                                   double rail_mass, double sleeper_mass);

struct Advice {
  std::string text;                   ///< for the log: factors and critical windows, several lines
  std::vector<std::string> warnings;  ///< what the user should know
  std::string refusal;                ///< why the explicit scheme of the case would not be stable; "" if it would
};

/// Judges the scheme of `coupling` on every axis, and gives the critical windows of all explicit schemes on the one
/// with the stiffest pad. Nothing is said of seats without a pad.
Advice advise(const proto::Coupling& coupling, const std::vector<SeatAxis>& axes);

}  // namespace coupler
