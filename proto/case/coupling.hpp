// `[coupling]`: what coupler and participants both have to know of the case.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "proto/case/scheme.hpp"

namespace proto {

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

/// Path of the rail within a window, as the explicit side follows it; coupler/README.md "Prolongation".
enum class Prolongation { linear, hermite };

/// `[coupling.iteration]`: how an implicit window is iterated, and when it has converged.
struct Iteration {
  enum class Acceleration { constant, aitken, iqn_ils };
  Acceleration acceleration = Acceleration::iqn_ils;
  double relaxation = 0.5;               ///< constant: every step's; else of the first step
  double force_tolerance = 1e-6;         ///< of the residual of the mean force, relative to its running scale
  double displacement_tolerance = 1e-6;  ///< of the change of the rail's displacement, relative to its running scale
  int max_iterations = 50;
  bool accept_at_limit = false;  ///< go on with what is there, and flag the window; false: stop
  int reused_windows = 8;        ///< iqn_ils: windows whose columns are used again
  double filter = 1e-2;          ///< iqn_ils: a column whose new part is smaller than this share is dropped
};

/// `[coupling.one_way]`: where the rail's motion comes from.
struct OneWay {
  std::string history;                    ///< a coupling.h5; empty: the fem participant, live
  std::vector<double> support_stiffness;  ///< live: under the whole pad, per seat axis [N/m]; empty: rigid
};

/// `[coupling.audit]`: what the interface may create, and what happens beyond.
struct AuditLimits {
  enum class Action { report, warn, switch_scheme, stop };
  double energy = 1e-3, momentum = 1e-4, moment = 1e-4;  ///< relative, as in coupler/README.md "Audit"
  Action action = Action::warn;
  Scheme switch_to = Scheme::robin_corrected;
  double work_scale = 0.0;     ///< expected sum of |W_rail| [J]; 0: the limits are looked at after the last window only
  double impulse_scale = 0.0;  ///< expected largest sum of |I| of a seat [N s]; likewise
};

/// `[coupling.advisor]`: what the stability of the schemes is judged by.
struct AdvisorInput {
  double rail_mass = 0.0;        ///< that moves with one seat [kg]; 0: as the participants say
  double sleeper_mass = 0.0;     ///< likewise
  bool accept_unstable = false;  ///< run an explicit scheme beyond its critical window all the same
};

/// `[coupling.checkpoint]`: when the run saves where it is.
struct CheckpointTimes {
  std::int64_t interval_windows = 0;  ///< 0: not by number of windows
  double interval_s = 600.0;          ///< of wall time; 0: not by time
};

struct Coupling {
  Scheme scheme = Scheme::robin_explicit;
  Prolongation prolongation = Prolongation::linear;
  Iteration iteration;
  OneWay one_way;
  AuditLimits audit;
  AdvisorInput advisor;
  double window_s = 5e-5;
  std::uint64_t n_windows = 0;
  int sub_cycle_factor = 1;        ///< sub-cycles of the march over those that stability asks for
  double output_interval_s = 0.0;  ///< of the participants' fields; 0: no field output
  Initialise initialise;
  CheckpointTimes checkpoint;
  double connect_timeout_s = 60.0;
  double stall_timeout_s = 60.0;  ///< alive but without progress
  ParticipantSpec qdem, fem;
};

/// Whether the rail is a record of another run, so that no fem participant takes part.
inline bool plays_recorded_rail(const Coupling& coupling) {
  return coupling.scheme == Scheme::one_way && !coupling.one_way.history.empty();
}

/// Why the scheme of the coupling cannot go on as its audit's switch_to; "" when it can, or need not.
std::string why_no_switch(const Coupling& coupling);

/// Reads `[coupling]` and its sub-tables. The keys, their defaults and meanings: coupler/README.md "Keys".
Coupling read_coupling(const CaseFile& file);

}  // namespace proto
