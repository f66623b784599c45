// Contact of two meshes: the reference for the half-space patch.
#pragma once

#include "fem_solver/contact/contact_analysis.hpp"

namespace fem {

/// Solves a case of two radii on two blocks of finite elements, quasi-static: pressure, and friction under a shift
/// along the rail. The surfaces' nodes face each other; displacements are small. Results are mirrored to the whole
/// patch, one element of the grid to a node. Throws proto::Error: config for a case that it does not cover; bad_data,
/// numerics.
ContactResult analyse_block_contact(const ContactCase& input);

}  // namespace fem
