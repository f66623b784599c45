// Settings of a track for the tests of the FEM side, without a case file.
#pragma once

#include <vector>

#include "fem_solver/assembly/rail_system.hpp"
#include "fem_solver/model/settings.hpp"

namespace tests {

/// Seat at x on the 60E1's foot, axes along the global ones, 3 x 3 cells.
inline proto::RailSeat rail_seat(double x) {
  proto::RailSeat seat;
  seat.name = "seat";
  seat.origin = {x, 0.7535, 0.0};
  seat.axes.setIdentity();
  seat.half_lengths = {0.075, 0.07};
  seat.cells = {3, 3};
  seat.stiffness = {60e6, 60e6, 225e6};
  seat.damping = {15e3, 15e3, 30e3};
  return seat;
}

/// 10 bays with four elements each, no gravity.
inline fem::FemSettings small_track() {
  fem::FemSettings s;
  s.n_bays = 10;
  s.element_length = 0.15;
  s.gravity = false;
  return s;
}

}  // namespace tests
