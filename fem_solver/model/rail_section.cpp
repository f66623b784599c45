#include "fem_solver/model/rail_section.hpp"

#include <Eigen/LU>
#include <cmath>

#include "fem_solver/model/section_blocks.hpp"
#include "fem_solver/model/section_warping.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

// 60E1 of EN 13674-1 (UIC60), right half, (y, z) in mm. The corners follow the standard's outline: height 172, foot
// 150, head 72 at 14.1 below the top with sides 1:20, web 16.5 (R508 sides), head and foot slopes 1:2.75 from 51
// and 31.5 at the centre line, foot edge 1:14 from 11.5, crown R300 - R80 - R13, head fillet R7. The foot fillet (R7,
// R35 and R120 in the standard) enters as one arc of 20 mm, which gives the tabulated area within 0.2 %. The outer head
// corner and the foot edge stand for their rounded arcs: they are placed so that the polygon keeps area and second
// moments.
const HalfCorners& half_60e1() {
  static const HalfCorners corners = [] {
    HalfCorners metres = {{21.0, 0.0},    {48.0, 0.0},   {75.0, 0.0},   {75.0, 10.8},  {48.0, 13.9},
                          {21.0, 23.9},   {12.5, 31.6},  {9.3, 44.0},   {8.2, 80.0},   {9.5, 118.0},
                          {12.5, 125.15}, {37.0, 135.0}, {35.4, 166.6}, {12.5, 171.72}};
    for (auto& p : metres) p *= 1e-3;
    return metres;
  }();
  return corners;
}

// Sizes of a standard's drawing [mm]. Head and foot depth: from top or bottom to where the fishing faces meet the plane
// of symmetry.
struct Sizes {
  double height, foot_width, head_width, web, head_depth, foot_depth;
};
constexpr Sizes sizes_60e1{172.0, 150.0, 72.0, 16.5, 51.0, 31.5};

// One shipped profile: table figures of its standard [cm2, cm4, kg/m].
struct Standard {
  const char* name;
  const char* source;
  Sizes sizes;
  double area, inertia_vertical, inertia_lateral, mass;
};

// Sizes of the Japanese rails: a maker's table of rail sections (columns of JIS E 1101). Areas and second moments: the
// project's table of rails, from memory of JIS E 1101.
constexpr Standard standards[] = {
    {"60E1", "EN 13674-1", sizes_60e1, 76.70, 3038.3, 512.3, 60.21},
    {"JIS60", "JIS E 1101", {174.0, 145.0, 65.0, 16.5, 49.0, 30.1}, 77.50, 3090.0, 512.0, 60.8},
    {"JIS50N", "JIS E 1101", {153.0, 127.0, 65.0, 15.0, 49.0, 30.0}, 64.20, 1960.0, 322.0, 50.4},
};

RailSection section_60e1() {
  RailSection s = block_section(half_60e1());
  // UIC60 of the rail database of rolland (Mantel, public code).
  s.torsion_constant = 2.212e-6, s.shear_vertical = 0.393, s.shear_lateral = 0.538;
  return s;
}

RailSection with_shear_constants(RailSection section) {
  const ShearConstants constants = shear_constants(section);
  section.torsion_constant = constants.torsion_constant;
  section.shear_vertical = constants.vertical, section.shear_lateral = constants.lateral;
  return section;
}

// The 60E1's corners brought to the drawing's sizes: foot, web and head are stretched each by itself.
HalfCorners scaled_60e1(const Sizes& to) {
  const Sizes& from = sizes_60e1;
  const double web_from = from.height - from.head_depth - from.foot_depth;
  const double web_to = to.height - to.head_depth - to.foot_depth;
  HalfCorners corners = half_60e1();
  for (int k = 0; k < n_half_corners; ++k) {
    auto& p = corners[k];
    const double z = p[1] * 1e3;
    if (z <= from.foot_depth)
      p[1] = z / from.foot_depth * to.foot_depth;
    else if (z < from.height - from.head_depth)
      p[1] = to.foot_depth + (z - from.foot_depth) / web_from * web_to;
    else
      p[1] = to.height - (from.height - z) / from.head_depth * to.head_depth;
    p[1] *= 1e-3;
    p[0] *= k <= 5 ? to.foot_width / from.foot_width : k <= 9 ? to.web / from.web : to.head_width / from.head_width;
  }
  return corners;
}

// The rest of the drawing (slopes, radii) was not to be had: the blocks keep the table's figures instead.
RailSection section_of(const Standard& standard) {
  const SectionTarget target{standard.area * 1e-4, 0.0, standard.inertia_vertical * 1e-8,
                             standard.inertia_lateral * 1e-8};
  constexpr double limit = 4e-3;  // [m]
  return with_shear_constants(block_section(fit_corners(scaled_60e1(standard.sizes), target, limit, standard.name)));
}

Eigen::Vector4d bilinear(const Eigen::Vector2d& l) {
  return {(1 - l[0]) * (1 - l[1]), l[0] * (1 - l[1]), (1 - l[0]) * l[1], l[0] * l[1]};
}

}  // namespace

RailSection::Place RailSection::locate(const Eigen::Vector2d& point) const {
  for (std::size_t q = 0; q < quads.size(); ++q) {
    Eigen::Matrix<double, 2, 4> corners;
    for (int k = 0; k < 4; ++k) corners.col(k) = vertices[quads[q][k]];
    Eigen::Vector2d local(0.5, 0.5);
    for (int iteration = 0; iteration < 20; ++iteration) {
      Eigen::Matrix<double, 4, 2> slope;
      slope << -(1 - local[1]), -(1 - local[0]), 1 - local[1], -local[0], -local[1], 1 - local[0], local[1], local[0];
      const Eigen::Vector2d step = (corners * slope).inverse() * (point - corners * bilinear(local));
      local += step;
      if (step.norm() < 1e-14 || local.norm() > 1e3) break;
    }
    const bool inside = local.minCoeff() > -1e-9 && local.maxCoeff() < 1 + 1e-9;
    if (inside && (corners * bilinear(local) - point).norm() < 1e-9) return {static_cast<int>(q), local};
  }
  throw proto::Error(proto::ExitCode::bad_data,
                     "the point y = " + std::to_string(point[0]) + " m, z = " + std::to_string(point[1]) +
                         " m lies outside the rail's cross-section",
                     "[[rail_seat]] and [fem] profile",
                     "keep the pad within the foot and the rail centred on the seat");
}

SectionProperties RailSection::properties() const {
  SectionSums sums;
  for (const auto& quad : quads) {
    const int ring[4] = {quad[0], quad[1], quad[3], quad[2]};
    for (int k = 0; k < 4; ++k) sums.add_edge(vertices[ring[k]], vertices[ring[(k + 1) % 4]]);
  }
  return sums.properties();
}

std::vector<std::string> rail_section_names() {
  std::vector<std::string> names;
  for (const auto& standard : standards) names.push_back(standard.name);
  return names;
}

RailSection rail_section(const std::string& name) {
  for (const auto& standard : standards)
    if (name == standard.name) return name == "60E1" ? section_60e1() : section_of(standard);
  const std::string nearest = proto::nearest_name(name, rail_section_names());
  throw proto::Error(proto::ExitCode::config, "unknown rail profile '" + name + "'", "fem.profile",
                     nearest.empty() ? "choose 60E1, JIS60 or JIS50N" : "did you mean '" + nearest + "'?");
}

RailSection rail_section_from_file(const std::string& path) {
  constexpr double limit = 6e-3;  // rounded corners stand further off than fitted ones [m]
  const RailOutline outline = read_rail_outline(path);
  return with_shear_constants(block_section(fit_corners(corners_of(outline, path), outline.properties(), limit, path)));
}

std::optional<StandardFigures> standard_figures(const std::string& name) {
  for (const auto& standard : standards)
    if (name == standard.name)
      return StandardFigures{standard.source, standard.area * 1e-4, standard.inertia_vertical * 1e-8,
                             standard.inertia_lateral * 1e-8, standard.mass};
  return std::nullopt;
}

}  // namespace fem
