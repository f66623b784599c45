// The bed by itself: `qdem_solver run`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "proto/case/case_file.hpp"
#include "qdem_solver/engine/energy_balance.hpp"
#include "qdem_solver/participant/track_bed.hpp"

namespace qdem {

/// What a run came to.
struct RunFigures {
  std::int64_t steps = 0;
  double smallest_step = 0.0, largest_step = 0.0;  ///< [s]
  double wall = 0.0;                               ///< integration only [s]
  double element_updates_per_s = 0.0;
  double sleeper_displacement = 0.0;  ///< mean along the seats' normals at the end [m]
  double pad_force = 0.0;             ///< sum along the seats' normals at the end [N]
  double coordination_number = 0.0;
  EnergyBalance energy;           ///< at the end
  double largest_residual = 0.0;  ///< of the energy ledger over the run, relative [-]
  std::string output;             ///< path of qdem.h5, "" when none was asked for
};

/// Integrates the bed of `file` for [qdem.run] duration_s under the loads of [[qdem.run.load]], artificial damping off.
/// Writes `out`/qdem.h5 at multiples of output_interval_s (and contacts.h5 where the case wants it), `out`/sensors.h5 at those of
/// sensor_interval_s.
/// `report(time)` is called now and then, `warn` as EnergyWatch does. Throws as TrackBed, and proto::Error (numerics).
RunFigures run_alone(const proto::CaseFile& file, const BedSource& source, const std::string& out,
                     const std::function<void(double)>& report, const std::function<void(const std::string&)>& warn);

}  // namespace qdem
