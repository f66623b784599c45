// The loads on patches (Model::loads) as the bodies feel them.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/span.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Forces of all loads of one model. Holds no history: that is in State::loads.
class PatchLoads {
 public:
  explicit PatchLoads(const Model& model);

  /// Takes state.loads to state.time, dt [s] later than they are, with positions state.x and velocities state.v; a
  /// falling weight takes the step of the engine's integrator. Sets them up first if they are none yet. Returns the
  /// work done on the bodies: mean of old and new force times the patch's way [J].
  double update(State& state, double dt) const;

  /// Adds the forces on the particles of `body` to `force`, laid out like state.x.
  void add(int body, const State& state, proto::Span<double> force) const;

 private:
  double along(std::size_t load, const std::vector<double>& field) const;
  double fall(const PatchLoad& load, LoadState& weight, double path, double rate, double time, double dt) const;

  const Model& model_;
  std::vector<std::vector<std::int64_t>> indices_;  ///< of component 0 of each patch's particles
};

}  // namespace qdem
