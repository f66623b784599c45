// The coupling schemes by name, and what each of them asks of the participants.
#pragma once

#include <string>
#include <vector>

namespace proto {

/// How the two sides are coupled; coupler/README.md "Schemes".
enum class Scheme {
  robin_explicit,       ///< R1
  robin_corrected,      ///< R2
  parallel_staggered,   ///< E0
  serial_staggered,     ///< E1
  serial_extrapolated,  ///< E2
  implicit,             ///< iterated to a tolerance
  one_way,              ///< the rail drives the sleeper and hears nothing of it
  rigid_per_step,       ///< GC: rigid joint, velocities equal in every sub-step
  rigid_per_window      ///< PH: rigid joint, velocities equal at every window's end
};

/// Names of all schemes as a case gives them, in the order of the enumeration: "R1", "R2", "E0", "E1", "E2",
/// "implicit", "one_way", "GC", "PH".
const std::vector<std::string>& scheme_names();
const std::string& name_of(Scheme scheme);
/// The scheme of that name; it must be one of scheme_names().
Scheme scheme_of(const std::string& name);

/// Whether the rail's side has the pad in its own equations.
bool uses_robin(Scheme scheme);
/// Whether windows are solved more than once.
bool needs_rollback(Scheme scheme);
/// Whether the joint is rigid: no pad, a force that keeps the velocities equal.
bool is_rigid(Scheme scheme);
/// Whether a run may go on with `to` on its way: both sides are configured for either alike.
bool can_switch(Scheme from, Scheme to);
/// Order of convergence in the window length, with several sub-cycles a window.
double expected_order(Scheme scheme);

}  // namespace proto
