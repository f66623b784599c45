// The table at the end of a run.
#pragma once

#include <string>

#include "coupler/record/summary.hpp"

namespace coupler {

/// What a person wants to know when the run is over: seats, wall time, interface defects, where the results are.
std::string run_table(const Summary& summary, const std::string& out);

}  // namespace coupler
