// Closed surfaces of triangles.
#pragma once

#include <array>
#include <vector>

#include "qdem_solver/model/model.hpp"

namespace qdem::bed {

/// A closed surface of triangles, outward by the right-hand rule.
struct Polyhedron {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::array<int, 3>> faces;
};

/// Enclosed volume in the cube of the corners' unit; negative when the surface is inside out.
double volume(const Polyhedron& shape);

/// Number of parts that share no edge.
int count_parts(const Polyhedron& shape);

/// The skin of a template, without the nodes inside.
Polyhedron skin_of(const Template& shape);

/// Do the two facets of the edge meet in a notch? Facets that are flush to round-off do not.
bool is_hollow(const Template& shape, const Edge& edge);

/// Has the skin no hollow edge?
bool is_convex(const Template& shape);

/// The frame in which a stone has its sieve size as unit of length: axes along the edges of its box, x the longest, z
/// the shortest, the middle extent 1. The box is the smallest of those with a side flush with a facet.
struct SieveFrame {
  Eigen::Matrix3d axes;  ///< rows, right-handed
  Eigen::Vector3d centre;
  double size = 1.0;  ///< middle extent in the unit of the corners
  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return axes * (x - centre) / size; }
};
SieveFrame sieve_frame(const Polyhedron& shape);

/// The shape in its sieve frame.
Polyhedron at_sieve_size(Polyhedron shape);

}  // namespace qdem::bed
