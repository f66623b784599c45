// What the FEM programs do without a partner.
#pragma once

#include <string>

#include "fem_solver/participant/fem_participant.hpp"

namespace fem {

/// Builds the rail and places the wheel along its whole way. Throws proto::Error for what cannot be run.
void check_case(const FemCase& input, const RailBuilder& build);

/// Prints section, deflection under the standing wheel and seat forces.
void print_static(const FemCase& input, const RailBuilder& build);

/// Runs the case with every seat on the support model; writes `out`/fem.h5 as `program`.
void run_alone(const FemCase& input, const RailBuilder& build, const std::string& program, const std::string& out);

}  // namespace fem
