// Histories of the seats of several runs, at common instants.
#pragma once

#include <string>
#include <vector>

#include "coupler/report/convergence.hpp"
#include "proto/case/rail_seat.hpp"

namespace coupler {

/// Every cell's values, or the mean displacement and total force of a seat.
enum class SeatValues { cells, means };

/// Per seat the displacement of rail and sleeper and the mean pad force, at the window ends (over the windows) of the
/// run with the longest windows, which is the first of `files` (coupling.h5). Windows of a later run must be whole
/// fractions. Throws proto::Error as proto::ResultReader does.
std::vector<Refinement> seat_refinements(const std::vector<std::string>& files,
                                         const std::vector<proto::RailSeat>& seats, SeatValues which);

}  // namespace coupler
