// A rail profile as mapped quadrilateral blocks: foot wings, foot centre, web and head.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fem_solver/model/rail_outline.hpp"

namespace fem {

/// Cross-section in its own frame: y lateral from the plane of symmetry, z up from the foot's bottom face [m].
struct RailSection {
  std::vector<Eigen::Vector2d> vertices;  ///< (y, z)
  /// Corners of each block in lexicographic order (y runs first): lower left, lower right, upper left, upper right.
  std::vector<std::array<int, 4>> quads;
  double head_half_width = 0.0;   ///< of the flat top of the middle block, where the wheel runs [m]
  double head_height = 0.0;       ///< of that flat top [m]
  double foot_half_width = 0.0;   ///< [m]
  double torsion_constant = 0.0;  ///< Saint-Venant's J [m4]; for a beam, as the next two
  double shear_vertical = 0.0;    ///< shear coefficient kappa: shear area over area
  double shear_lateral = 0.0;     ///< the same across

  /// Block that holds (y, z) to 1e-9 m and the point's coordinates in [0, 1]^2 of it.
  /// Throws proto::Error (bad_data) when no block holds the point.
  struct Place {
    int quad;
    Eigen::Vector2d local;
  };
  Place locate(const Eigen::Vector2d& point) const;

  /// Exact for the blocks' straight edges.
  SectionProperties properties() const;
};

/// The profile called `name`: "60E1", "JIS60" or "JIS50N". Throws proto::Error (config) for an unknown name, with the
/// nearest one.
RailSection rail_section(const std::string& name);

/// Names that rail_section() accepts.
std::vector<std::string> rail_section_names();

/// Blocks with area, centroid and second moments of the outline in a file; see read_rail_outline(), corners_of() and
/// fit_corners() for what they refuse. Torsion constant and shear coefficients come from shear_constants().
RailSection rail_section_from_file(const std::string& path);

/// What a standard's table says of a shipped profile.
struct StandardFigures {
  std::string source;
  double area;              ///< [m2]
  double inertia_vertical;  ///< [m4]
  double inertia_lateral;   ///< [m4]
  double mass;              ///< [kg/m]
};
/// Empty for a name that rail_section() does not know.
std::optional<StandardFigures> standard_figures(const std::string& name);

}  // namespace fem
