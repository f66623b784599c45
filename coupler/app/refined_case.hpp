// A case with finer rail seats.
#pragma once

#include <string>

#include "proto/case/case_file.hpp"

namespace coupler {

/// The text of a case with the `cells` of every [[rail_seat]] multiplied by `factor` along both axes, for a file in any
/// folder: its `case_folder` is that of the original. Throws proto::Error (config) when a [[rail_seat]] has no line
/// `cells = [n, m]`.
std::string with_finer_cells(const proto::CaseFile& original, int factor);

}  // namespace coupler
