// The way to a state of rest in few steps: a step for the contacts, and inertia that makes it stable for all else.
#pragma once

#include <vector>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Contact points of a stone in a bed near rest: few, so that stones with little support, which are the last to find
/// their place, keep their true inertia. Those with more are made heavier.
inline constexpr int resting_points = 1;

/// Drag on deformation while relaxing [1/s]: in a step it takes this share of its velocity, times the local damping;
/// strong for what the step resolves well, and a twentieth of the step's budget at most.
inline double relaxation_drag(double local_damping, double dt) {
  return dt > 0 ? 0.05 * local_damping / dt : 0.0;
}

/// Step that a stone of mean mass, or where there is none the sleeper, with `n_contacts` contact points takes at `safety` of its bound as a rigid body [s].
///
/// Stones of rock are a hundred times stiffer than their contacts, and so limit the true step to a small part of this.
double relaxation_step(const Model& model, int n_contacts, double safety);

/// Keeps Model::inertia of one model such that step() is a share `safety` of the stable one for every body, its
/// elements, its contacts, pads and their dashpots. All candidates that nearly touch are taken as touching, and at
/// least `n_contacts` on every stone; fit() anew as bodies come together. No inertia is below the true one.
class Relaxation {
 public:
  /// The model must outlive the object and keep all but planes, loads and damping.
  Relaxation(Model& model, int n_contacts, double safety);

  double step() const { return step_; }  ///< [s]
  /// Fits the inertia and prepares the engine; pads unloaded.
  void begin(Engine& engine, State& state);
  void fit(const Engine& engine, const State& state);

 private:
  Model& model_;
  int n_contacts_;
  double safety_, step_;
  std::vector<Rates> elements_, boundary_;  ///< of every body
  Rates pads_;
};

}  // namespace qdem
