// The case files of cases/, as they were when the coupler was built: what `coupler init` copies.
#pragma once

#include <string>
#include <vector>

namespace coupler {

struct ShippedCase {
  std::string name;
  std::string text;  ///< case.toml
};

/// Those that need no other file.
const std::vector<ShippedCase>& shipped_cases();

}  // namespace coupler
