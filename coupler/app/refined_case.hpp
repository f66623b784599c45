// A case with finer rail seats.
#pragma once

#include <string>

namespace coupler {

/// The text of a case with the `cells` of every [[rail_seat]] multiplied by `factor` along both axes. Throws
/// proto::Error (config) when a [[rail_seat]] has no line `cells = [n, m]`.
std::string with_finer_cells(const std::string& case_text, int factor);

}  // namespace coupler
