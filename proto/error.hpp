// Errors that end a program: one message a person can act on, one exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace proto {

/// Exit codes of every program of this house (the numbers of sysexits.h).
enum class ExitCode : int {
  ok = 0,
  usage = 64,         ///< command line
  bad_data = 65,      ///< mesh, material, physical set-up that cannot be computed
  missing_input = 66, ///< a file that is not there
  unavailable = 69,   ///< a peer is lost: exited, hung, unreachable
  internal = 70,      ///< a defect of this program
  os_error = 71,      ///< the operating system refused (process, memory, device)
  cannot_create = 73, ///< an output that cannot be created
  io_error = 74,      ///< an output that cannot be written, a disk that is full
  numerics = 75,      ///< NaN, blow-up, no convergence: stopped with step, time and entity
  protocol = 76,      ///< a message that breaks proto/README.md
  config = 78,        ///< the case file
};

/// An error that ends the program. Caught only in an `app/` main function.
///
/// The text is built as: *problem (why) - where - what to do*; `where` and `advice` may be empty.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& problem, const std::string& where = {}, const std::string& advice = {});
  ExitCode code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// Of `known`, the name nearest to `name` in edit distance when it is at most 3 edits away; empty otherwise.
/// Used for "did you mean" in every message about an unknown name.
template <class Names>
std::string nearest_name(const std::string& name, const Names& known);

/// Number of single-character insertions, deletions and substitutions between two words.
int edit_distance(const std::string& a, const std::string& b);

template <class Names>
std::string nearest_name(const std::string& name, const Names& known) {
  std::string best;
  int best_distance = 4;
  for (const auto& candidate : known) {
    const int distance = edit_distance(name, candidate);
    if (distance < best_distance) best_distance = distance, best = candidate;
  }
  return best;
}

}  // namespace proto
