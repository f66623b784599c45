// Stone templates from the user's files: meshes of tetrahedra, and scanned surfaces that are coarsened and filled.
#pragma once

#include <string>

#include "qdem_solver/bed/stone_shape.hpp"

namespace qdem::bed {

/// Endings of files that can be stones.
inline const std::vector<std::string> stone_file_endings = {".msh", ".stl", ".obj"};

/// One template for every file of `wanted.files`, in their order, named as the file and scaled to a middle extent of
/// 1 m, so that the unit of the file does not matter. A mesh is taken as it is; a surface becomes a mesh between
/// least_tets and most_tets. Repairs, coarsening and stable steps below 0.75 of the median are told in the notes.
/// Throws proto::Error (bad_data), naming the file, for what cannot be repaired or meshed, and for a stable step below
/// 0.25 of the median.
StoneTemplates read_stone_templates(const StoneShapes& wanted);

}  // namespace qdem::bed
