// Where a run stands, as text.
#pragma once

#include <string>

#include "coupler/record/run_status.hpp"

namespace coupler {

/// "waits 3 %": the share of the wall time since start-up in which nobody computed; "" before there is any.
std::string wait_text(const WallTime& wall);

/// The whole status in a few lines, each ended by a newline.
std::string status_block(const RunStatus& status);

/// The same on one line, without a newline.
std::string status_line(const RunStatus& status);

}  // namespace coupler
