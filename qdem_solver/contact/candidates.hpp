// The candidate list: which nodes, edges and triangles may touch before anything moved by half the skin.
#pragma once

#include <vector>

#include "qdem_solver/contact/body_skin.hpp"

namespace qdem {

/// Candidates in ascending key order; the layout of ContactState.
struct CandidateList {
  std::vector<ContactKey> keys;
  std::vector<int> triangle_offsets, triangles;
};

/// Axis-aligned box of a body's nodes.
struct BodyBox {
  Eigen::Vector3d low, high;
};
std::vector<BodyBox> body_boxes(const std::vector<BodySkin>& skins, const double* positions);

/// For every body the bodies whose boxes come within `reach` [m] of its own, ascending; both directions are listed.
/// Sort and sweep along the longest extent of the scene.
std::vector<std::vector<int>> near_bodies(const std::vector<BodyBox>& boxes, double reach);

/// All pairs of features of different bodies, or of a body and a plane at its place of `time`, whose surfaces are
/// nearer than `skin` [m] at `positions`: node-skin and edge-edge pairs within 2 x rounding + skin of each other, or
/// with spheres the pairs of nodes. The same list for any number of threads.
CandidateList find_candidates(const Model& model, const std::vector<BodySkin>& skins, const double* positions,
                              double skin, double time);

}  // namespace qdem
