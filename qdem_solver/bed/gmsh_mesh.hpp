// The door to Gmsh: tetrahedra that fill a polyhedron, and meshes from its files.
#pragma once

#include <string>

#include "qdem_solver/bed/polyhedron.hpp"

namespace qdem::bed {

/// Tetrahedra of a closed polyhedron by Gmsh with edges of about `size` [m]. Throws proto::Error (bad_data) if it
/// fails.
Template mesh_polyhedron(const std::string& name, const Polyhedron& shape, double size);

struct TetMesh {
  std::vector<Eigen::Vector3d> nodes;    ///< in the unit of the file; only those of tetrahedra
  std::vector<std::array<int, 4>> tets;  ///< as they are in the file
  std::vector<std::size_t> tags;         ///< of the tetrahedra in the file
};

/// The 4-node tetrahedra of a mesh file of Gmsh; elements of other kinds are left out. Throws proto::Error (bad_data)
/// for a file that is none, or has none.
TetMesh read_msh(const std::string& path);

}  // namespace qdem::bed
