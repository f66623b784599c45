// Bodies that stand in each other before anything moves.
#pragma once

#include <string>
#include <vector>

#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// The deepest contact of a pair of bodies, or of a body and a plane.
struct InitialOverlap {
  int body_a = 0, body_b = 0;  ///< b < 0: plane ~b
  int point = 0;               ///< node of a, or one end of its edge
  double depth = 0.0;          ///< of the rounded surfaces or spheres [m]
  double edge = 0.0;           ///< mean surface edge of the body with the finer mesh [m]
};

/// Pairs that overlap by more than `share` of the edge, the deepest first. Looks the contacts up anew; the state stays.
std::vector<InitialOverlap> initial_overlaps(const Model& model, const State& state, double share);

/// Throws proto::Error (bad_data) with the number of such pairs and the deepest of them: bodies, point, overlap, share
/// of the edge. `where` says whose scene it is, `advice` what to do.
void refuse_initial_overlaps(const Model& model, const State& state, double share, const std::string& where,
                             const std::string& advice);

}  // namespace qdem
