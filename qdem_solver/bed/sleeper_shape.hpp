// The half sleeper as a box of tetrahedra.
#pragma once

#include "qdem_solver/model/model.hpp"

namespace qdem::bed {

/// A box low..high [m] cut into cells of about `cell` [m] (a whole number along each axis), six tetrahedra a cell
/// around its main diagonal, so that neighbouring cells match.
Template box_shape(const std::string& name, const Eigen::Vector3d& low, const Eigen::Vector3d& high, double cell);

}  // namespace qdem::bed
