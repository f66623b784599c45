// Where a result came from, as attributes for every result file.
#pragma once

#include <cstdint>
#include <string>

#include "proto/result/attributes.hpp"

namespace proto {

/// `program`, `version`, `source` (git describe when the build was configured, "unknown" outside a checkout),
/// `hdf5_version`, `compiler`, `case_name`, `case_hash` (16 hexadecimal digits) and `case_text`. No time of day, host
/// or path: equal runs must give equal files.
Attributes provenance(const std::string& program, const std::string& case_name, std::uint64_t case_hash,
                      const std::string& case_text);

std::string project_version();     ///< of the top CMakeLists.txt
std::string source_description();  ///< git describe --always --dirty

}  // namespace proto
