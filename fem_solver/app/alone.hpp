// What fem_solver does without a partner.
#pragma once

#include <string>

#include "fem_solver/participant/fem_participant.hpp"

namespace fem {

/// Builds the mesh and places the wheel along its whole way. Throws proto::Error for what cannot be run.
void check_case(const FemCase& input);

/// Prints section, deflection under the standing wheel and seat forces.
void print_static(const FemCase& input);

/// Runs the case with every seat on the support model; writes `out`/fem.h5.
void run_alone(const FemCase& input, const std::string& out);

}  // namespace fem
