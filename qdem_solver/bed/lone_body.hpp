// Scenes without a bed: the sleeper alone, or one stone.
#pragma once

#include "qdem_solver/bed/bed.hpp"
#include "qdem_solver/bed/settings.hpp"

namespace qdem::bed {

/// Turns a stone onto the facet that its centre of mass is nearest to, of those with the whole stone on one side: there
/// it stands safely. Throws proto::Error (bad_data) if the stone has no such facet.
Eigen::Matrix3d resting_rotation(const Template& stone);

/// The scene of `settings.scene`, which is not `ballast`.
/// `sleeper`: the half sleeper at its place, without ground; only its symmetry holds it.
/// `stone`: one stone of the first template and the size d50 under the first rail seat. It lies on the ground, at rest
/// to `unbalanced_limit`; without gravity it floats five roundings higher. The sleeper is held at its place.
/// Throws proto::Error: bad_data when the stone does not come to rest within `rest_steps`, or as resting_rotation().
Bed lone_body(const Settings& settings, const BedPhysics& physics);

}  // namespace qdem::bed
