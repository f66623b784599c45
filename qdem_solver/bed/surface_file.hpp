// Triangle surfaces in files: STL (text or binary) and OBJ, by CGAL.
#pragma once

#include <string>

#include "qdem_solver/bed/polyhedron.hpp"

namespace qdem::bed {

/// The surface as it is in the file, in the file's unit; polygons of an OBJ are cut into triangles. Throws
/// proto::Error: missing_input, or bad_data for a file that is no such surface.
Polyhedron read_surface(const std::string& path);

/// Writes a binary STL of coordinates times `factor`. Throws proto::Error (cannot_create).
void write_stl(const std::string& path, const Polyhedron& shape, double factor);

}  // namespace qdem::bed
