// Stone templates: irregular convex polyhedra like crushed rock, or bodies from files, filled with tetrahedra.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "qdem_solver/bed/polyhedron.hpp"

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
  std::vector<std::string> files;  ///< of meshes or scans, a template each; empty: stones are generated
};

/// Convex hull of points in general position: every triangle that has all other points on one side. Meant for a few
/// dozen points. Points inside are left out of `corners`.
Polyhedron convex_hull(const std::vector<Eigen::Vector3d>& points);

/// A stone whose extents along its axes x, y, z are elongation, 1 and flatness [m]: the hull of points that are spread
/// over an ellipsoid at random, at least 30 degrees from each other seen from the centre, with a jitter of the radius.
Polyhedron random_stone(double elongation, double flatness, std::uint64_t seed, std::uint64_t number);

struct StoneTemplates {
  std::vector<Template> templates;  ///< middle extent 1 m: the scale of a body is its sieve size
  std::vector<std::string> notes;   ///< candidates that were refused, files that were repaired, with the reason
};

/// The templates of a bed, generated or from files: reproducible from the seed or from the files' content. Throws
/// proto::Error (bad_data) for stones that cannot be meshed, or a file that read_stone_templates() refuses.
StoneTemplates make_stone_templates(const StoneShapes& wanted);

}  // namespace qdem::bed
