// Forces on particles as the engine finds them.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "qdem_solver/engine/engine.hpp"

namespace tests {

/// Forces [N] on the particles of body 0, from accelerations the engine finds.
inline std::vector<Eigen::Vector3d> forces(const qdem::Model& model, qdem::State& state) {
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  std::vector<Eigen::Vector3d> result;
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    result.push_back(model.node_mass(0, i) * qdem::State::gather(model, state.a, 0, i));
  }
  return result;
}

}  // namespace tests
