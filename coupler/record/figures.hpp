// The figures of a run that people look at first.
#pragma once

#include <string>
#include <vector>

#include "coupler/scheme/window_record.hpp"
#include "proto/case/rail_seat.hpp"
#include "proto/result/state_archive.hpp"

namespace coupler {

/// Largest magnitudes along the normal axis of one seat since time 0.
struct SeatFigures {
  std::string name;
  double max_force_n = 0.0;                 ///< window mean of the pad force, summed over the cells
  double max_rail_displacement_m = 0.0;     ///< mean over the cells
  double max_sleeper_displacement_m = 0.0;  ///< mean over the cells
};

/// Where the wall time went; total is the sum of the others.
struct WallTime {
  double total = 0.0;
  double start_up = 0.0;  ///< from the start of the participants to their being configured
  double qdem = 0.0;      ///< computing, as the participant reports it
  double fem = 0.0;
  double waiting = 0.0;  ///< of the coupler after start-up, beyond the participants' computing: transport, their output
  double coupler = 0.0;  ///< the coupler's own work
};

/// Normal force of every seat in a window: the impulse of the pad force on the sleeper over H, summed over the cells
/// [N].
std::vector<double> seat_forces(const WindowRecord& record, const std::vector<proto::RailSeat>& seats, double window_s);

/// The figures of every seat, on their way into a checkpoint and back.
void exchange(proto::StateArchive& archive, std::vector<SeatFigures>& figures);

/// Takes one more window into the figures of every seat.
void update_figures(std::vector<SeatFigures>& figures, const WindowRecord& record,
                    const std::vector<proto::RailSeat>& seats, double window_s);

}  // namespace coupler
