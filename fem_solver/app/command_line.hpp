// The command line that the FEM programs have in common.
#pragma once

#include <string>

#include "fem_solver/app/contact_tool.hpp"
#include "fem_solver/rail/rail_model.hpp"
#include "fem_solver/wheel/wheel_model.hpp"

namespace fem {

/// One program: its rail and wheel are what distinguishes it.
struct FemProgram {
  std::string name, description;
  RailBuilder build;
  WheelBuilder build_wheel;
  ContactAnalyser blocks = nullptr;  ///< of the tool `contact`, where the program has solid elements
};

/// Carries out `participant`, `check`, `static`, `run` or `contact`; the exit code. Errors become one line on stderr.
int fem_program(int argc, char** argv, const FemProgram& program);

}  // namespace fem
