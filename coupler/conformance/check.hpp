// One check of the conformance suite, and what it found.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace coupler::conformance {

class Bench;

enum class Outcome { pass, fail, not_offered };

/// What a check found; `reason` is one line for a person, never empty unless it passed without anything to tell.
struct Verdict {
  Outcome outcome = Outcome::pass;
  std::string reason;
};

inline Verdict pass(std::string reason = {}) {
  return {Outcome::pass, std::move(reason)};
}
inline Verdict fail(std::string reason) {
  return {Outcome::fail, std::move(reason)};
}
inline Verdict not_offered(std::string reason) {
  return {Outcome::not_offered, std::move(reason)};
}

/// Whom a check is for.
enum class Role { both, qdem, fem };

/// A check starts the participant anew, as often as it needs. A proto::Error that it throws counts as its failure.
struct Check {
  const char* name;  ///< as `--only` takes it
  const char* what;  ///< what a participant that passes does
  Role role;
  Verdict (*run)(Bench&);
};

// The groups of checks, each in a source file of its name.
std::vector<Check> handshake_checks();  ///< who it is, what it registers
std::vector<Check> window_checks();     ///< what it answers in a window
std::vector<Check> state_checks();      ///< what it keeps: rollback, save and restore, repeated requests
std::vector<Check> message_checks();    ///< what it does with messages that it has to refuse
std::vector<Check> process_checks();    ///< heartbeats, end, abort, kill

}  // namespace coupler::conformance
