// From a profile's outline to the thirteen blocks of a rail's cross-section.
#pragma once

#include "fem_solver/model/rail_outline.hpp"
#include "fem_solver/model/rail_section.hpp"

namespace fem {

/// Figures that a section's blocks shall have. A centroid height of zero leaves the centroid free.
using SectionTarget = SectionProperties;

/// Right halves (y, z) of the corners of the blocks, in the order of block_section() [m].
using HalfCorners = std::vector<Eigen::Vector2d>;
constexpr int n_half_corners = 14;

/// Joins mirrored corners into 13 blocks: five of the foot, five of the web, three of the head. Corners 0-2 lie on the
/// foot's bottom, 3-5 on its top from the edge inwards, 6-9 up the web, 10-11 on the head's underside, 12-13 on its top
/// from the edge inwards.
RailSection block_section(const HalfCorners& corners);

/// Moves corners by the least sum of squares such that the blocks get the figures of `target` to 1e-9. Foot width, head
/// top and the foot's bottom stay. Throws proto::Error (bad_data, `where`) when a corner would move by more than
/// `limit` [m] or a block would not stay convex: the outline is no rail that these blocks can stand for.
HalfCorners fit_corners(HalfCorners corners, const SectionTarget& target, double limit, const std::string& where);

/// Corners at characteristic places of an outline: foot edge and slope, fillet, web, head. They lie on the outline,
/// which the blocks' straight edges cut short: fit_corners() makes up for it. Throws proto::Error (bad_data, `where`)
/// for an outline without foot, web and head, with the reason.
HalfCorners corners_of(const RailOutline& outline, const std::string& where);

}  // namespace fem
