// Stone templates: irregular convex polyhedra like crushed rock, filled with tetrahedra.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "qdem_solver/model/model.hpp"

namespace qdem::bed {

struct ShapeRange {
  double lowest, highest;
};

/// What the templates have to be.
struct StoneShapes {
  int n_templates = 24;
  ShapeRange elongation{1.1, 1.7};  ///< longest / middle extent [-]
  ShapeRange flatness{0.55, 0.95};  ///< shortest / middle extent [-]
  int least_tets = 50, most_tets = 100;
  std::uint64_t seed = 1;
};

/// A closed surface of triangles, outward by the right-hand rule.
struct Polyhedron {
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::array<int, 3>> faces;
};

/// Convex hull of points in general position: every triangle that has all other points on one side. Meant for a few
/// dozen points. Points inside are left out of `corners`.
Polyhedron convex_hull(const std::vector<Eigen::Vector3d>& points);

/// A stone whose extents along its axes x, y, z are elongation, 1 and flatness [m]: the hull of points that are spread
/// over an ellipsoid at random, at least 30 degrees from each other seen from the centre, with a jitter of the radius.
Polyhedron random_stone(double elongation, double flatness, std::uint64_t seed, std::uint64_t number);

/// Tetrahedra of a closed polyhedron by Gmsh with edges of about `size` [m]. Throws proto::Error (bad_data) if it
/// fails.
Template mesh_polyhedron(const std::string& name, const Polyhedron& shape, double size);

struct StoneTemplates {
  std::vector<Template> templates;  ///< middle extent 1 m: the scale of a body is its sieve size
  std::vector<std::string> notes;   ///< candidates that were refused, with the reason
};

/// The templates of a bed. Of every candidate stone the mesh between least_tets and most_tets with the largest stable
/// step is taken; candidates without one, or with a step below 0.75 of the median, are refused and reported.
/// Reproducible from the seed.
StoneTemplates make_stone_templates(const StoneShapes& wanted);

}  // namespace qdem::bed
