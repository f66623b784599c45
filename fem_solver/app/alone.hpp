// What the FEM programs do without a partner.
#pragma once

#include <string>

#include "fem_solver/app/command_line.hpp"
#include "fem_solver/participant/fem_participant.hpp"

namespace fem {

/// Builds the rail and places the wheel along its whole way. Throws proto::Error for what cannot be run.
void check_case(const FemCase& input, const FemProgram& program);

/// Prints section, deflection under the standing wheel and seat forces.
void print_static(const FemCase& input, const FemProgram& program);

/// Runs the case with every seat on the support model; writes `out`/fem.h5.
void run_alone(const FemCase& input, const FemProgram& program, const std::string& out);

}  // namespace fem
