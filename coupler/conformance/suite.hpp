// All checks in their order, and the report.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "coupler/conformance/bench.hpp"
#include "coupler/conformance/check.hpp"

namespace coupler::conformance {

/// What one check found, and how long it took.
struct Finding {
  const Check* check = nullptr;
  Verdict verdict;
  double seconds = 0.0;
};

/// Every check, in the order in which they are run.
const std::vector<Check>& all_checks();

/// Runs the checks for the candidate's role, those named in `only` if it is not empty; `tell` hears of each. Throws
/// Interrupted when the user stops it; what a participant does wrong is a finding.
std::vector<Finding> run_suite(Bench& bench, const std::set<std::string>& only,
                               const std::function<void(const Finding&)>& tell);

/// True when no check failed.
bool conforms(const std::vector<Finding>& findings);

/// One line of the page for people.
std::string report_line(const Finding& finding);

/// The report for scripts: participant, command, case, conforms, checks [name, what, outcome, reason, seconds].
std::string report_json(const Candidate& candidate, const std::vector<Finding>& findings);

}  // namespace coupler::conformance
