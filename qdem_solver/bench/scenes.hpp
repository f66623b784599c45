// Scenes whose rates are measured.
#pragma once

#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem::bench {

struct Scene {
  Model model;
  State state;
};

/// About `n_elements` in stones of one template, 108 tetrahedra each, apart from each other.
Scene stones(int n_elements);

/// One body of about `n_elements`: a mesh that shares its shape with nobody.
Scene single_mesh(int n_elements);

/// Boxes piled in contact, each layer turned against the one below: nodes on faces and edges across edges.
Scene pile();

}  // namespace qdem::bench
