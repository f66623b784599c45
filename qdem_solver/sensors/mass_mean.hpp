// Mean of a body's particles by their masses: its centre, or the velocity of that.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// `values`: an array laid out like State::x.
inline Eigen::Vector3d mass_mean(const Model& model, const std::vector<double>& values, int body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < model.shape(body).n_nodes(); ++i) {
    sum += model.node_mass(body, i) * State::gather(model, values, body, i);
  }
  return sum / model.body_mass(body);
}

}  // namespace qdem
