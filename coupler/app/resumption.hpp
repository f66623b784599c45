// What `coupler run --resume` finds in the folder of an earlier run.
#pragma once

#include <set>
#include <string>

#include "coupler/app/case_input.hpp"
#include "coupler/record/checkpoint.hpp"
#include "coupler/record/run_folder.hpp"

namespace coupler {

struct Resumption {
  CaseInput input;
  Checkpoint set;
};

/// The newest usable set of the folder, and the case: `case_path`, or, if that is empty, where the run found it.
/// Damaged sets are told on stderr and passed over. Throws proto::Error: missing_input when there is no set or no case;
/// config, with the list of what differs, when the case or the program's version is not what the set was made with and
/// `allowed` does not name "case" or "version".
Resumption find_resumption(const RunFolder& folder, const std::string& case_path, const std::set<std::string>& allowed);

}  // namespace coupler
