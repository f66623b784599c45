// What artificial boundaries (Model::boundary) do to the bodies.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/span.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Springs and dashpots of all boundary particles of one model. Without history.
class BoundaryForces {
 public:
  explicit BoundaryForces(const Model& model);

  /// Adds the forces at positions state.x and velocities state.v on the particles of `body` to `force`, laid out like
  /// state.x.
  void add(int body, const State& state, proto::Span<double> force) const;
  double radiated_power(const State& state) const;  ///< into the dashpots at state.v [W]
  double energy(const State& state) const;          ///< of the springs [J]

 private:
  struct Entry {
    const BoundaryParticle* particle;
    std::int64_t index;  ///< of component 0
    int stride;
  };
  std::vector<std::vector<Entry>> entries_;  ///< of every body
};

}  // namespace qdem
