// Pictures that other programs draw.
#pragma once

#include <string>
#include <vector>

namespace coupler {

/// Has `program` (looked up in PATH) make `picture` from `script`, which is among the arguments; says on stdout where
/// the picture is, or why there is none. Never throws proto::Error: a picture less ends no command.
void draw(const std::string& program, const std::vector<std::string>& arguments, const std::string& script,
          const std::string& picture);

}  // namespace coupler
