// `[coupling]`: what coupler and participants both have to know of the case.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"

namespace proto {

/// How the two sides are coupled; coupler/README.md "Schemes".
enum class Scheme { robin_explicit, robin_corrected, serial_staggered, serial_extrapolated };  // R1, R2, E1, E2

/// Names of all schemes, as a case gives them: "R1", "R2", "E1", "E2".
const std::vector<std::string>& scheme_names();
const std::string& name_of(Scheme scheme);
/// The scheme of that name; it must be one of scheme_names().
Scheme scheme_of(const std::string& name);
/// Whether the rail's side has the pad in its own equations.
bool uses_robin(Scheme scheme);

/// How the coupler starts one participant: `command` plus the arguments of proto/README.md "Starting a participant".
struct ParticipantSpec {
  std::string name;                  ///< "qdem", "fem": the two roles of the interface
  std::vector<std::string> command;  ///< program (looked up beside the coupler, then in PATH) and its first arguments
};

/// `[coupling.initialise]`: coupled relaxation before time 0, and what counts as rest.
struct Initialise {
  double window_s = 0.0;  ///< of this phase
  int max_windows = 0;    ///< 0: no initialise phase
  int min_windows = 0;
  int check_windows = 40;             ///< over which all of the following must hold
  double tolerance = 1e-3;            ///< change of the seat force, relative to the larger of itself and force_floor
  double force_floor = 0.0;           ///< [N]
  double qdem_residual_limit = 5e-3;  ///< of Result.residual [-]
  double fem_residual_limit = 5e-3;   ///< of Result.residual [-]
};

/// `[coupling.checkpoint]`: when the run saves where it is.
struct CheckpointTimes {
  std::int64_t interval_windows = 0;  ///< 0: not by number of windows
  double interval_s = 600.0;          ///< of wall time; 0: not by time
};

struct Coupling {
  Scheme scheme = Scheme::robin_explicit;
  double window_s = 5e-5;
  std::uint64_t n_windows = 0;
  double output_interval_s = 0.0;  ///< of the participants' fields; 0: no field output
  Initialise initialise;
  CheckpointTimes checkpoint;
  double connect_timeout_s = 60.0;
  double stall_timeout_s = 60.0;  ///< alive but without progress
  ParticipantSpec qdem, fem;
};

/// Reads `[coupling]`:
///   scheme (a name), window_s, duration_s (a whole number of windows), output_interval_s, connect_timeout_s,
///   stall_timeout_s, qdem_command [..] (default ["qdem_solver", "participant"]), fem_command [..] (default
///   ["fem_solver", "participant"]); [coupling.initialise] window_s (default: coupling.window_s), max_windows,
///   min_windows, check_windows, tolerance, force_floor_n, qdem_residual_limit, fem_residual_limit;
///   [coupling.checkpoint] interval_windows, interval_s.
Coupling read_coupling(const CaseFile& file);

}  // namespace proto
