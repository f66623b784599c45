// Where a deformed body would be if it were rigid.
#pragma once

#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// The placement of a body of the given scale with the particles' centre of mass and the rotation that comes nearest to
/// them: least squares weighted with the particles' masses. Source: Kabsch, Acta Cryst. A32 (1976) 922.
Placement rigid_fit(const Model& model, const State& state, int body, double scale);

}  // namespace qdem
