// Where programs are.
#pragma once

#include <string>

namespace coupler {

/// Absolute path of the running program.
std::string own_path();

/// Absolute path of `program`: as written when it has a "/", else beside the coupler, else in PATH.
/// Throws proto::Error (missing_input) with `where` when there is no such executable file.
std::string find_program(const std::string& program, const std::string& where);

}  // namespace coupler
