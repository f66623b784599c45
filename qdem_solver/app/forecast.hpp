// What a case will cost on this machine.
#pragma once

#include "proto/case/case_file.hpp"

namespace qdem {

/// Prints number of stones, memory, steps and wall time that the case will take. Measures the machine for a second.
void print_forecast(const proto::CaseFile& file);

}  // namespace qdem
