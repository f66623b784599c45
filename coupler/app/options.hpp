// What the command line asks for.
#pragma once

#include <string>

namespace coupler {

struct RunOptions {
  std::string case_path;
  std::string out;     ///< empty: runs/<case>-<time>
  std::string scheme;  ///< "R1", "E1", or empty: as the case says
  int n_threads = 0;   ///< of each participant; 0: as the environment says
};

/// Exit code of a completed, or cleanly interrupted, run. Throws proto::Error when it fails.
int run_case(const RunOptions& options);

/// Validates the case: the coupler's own and the common sections, then each participant's `check`.
/// Returns 0, or the exit code of the participant that refused (which has said why on stderr). Throws proto::Error.
int check_case(const std::string& case_path);

}  // namespace coupler
