// Stress of one element, for output and reports.
#pragma once

#include <Eigen/Core>

#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Cauchy stress, viscous part included, of tetrahedron `element` of a body [Pa], world axes, tension positive.
///
/// Of a bonded body: the virial of the tetrahedron's shares of its six bonds, sum f (x) d / V. A single value has no
/// meaning of its own; the mean over a body that carries surface forces is its mean stress, as for quadruples.
Eigen::Matrix3d element_stress(const Model& model, const State& state, int body, int element);

}  // namespace qdem
