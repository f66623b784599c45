// Porosity of a region by sampling points.
#pragma once

#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem::bed {

/// Share of the box low..high [m] that is in no stone, by points on a lattice of about `pitch` [m]. A point is in a
/// convex stone when it lies on the inner side of all its faces, each moved outward by `rounding` [m]: the rounded
/// stone, its edges not rounded off; in any other stone when it is in one of its tetrahedra or within `rounding` of its
/// skin.
double porosity(const Model& model, const State& state, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                double pitch, double rounding);

}  // namespace qdem::bed
