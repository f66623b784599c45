// The track at rest.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem_solver/assembly/track_system.hpp"
#include "fem_solver/contact/running_band.hpp"
#include "fem_solver/linear/cholesky.hpp"
#include "proto/pad/pad_law.hpp"

namespace fem {

struct StaticState {
  Eigen::VectorXd displacement;  ///< all degrees of freedom [m]
  Eigen::VectorXd pad_force;     ///< on the sleepers: coupled cells, then TrackSystem::support_laws [N]
};

/// Static solutions on one factorisation of K_r + K_s; everything is computed in the constructor but the superposition.
class Statics {
 public:
  Statics(const TrackSystem& system, const RunningBand& band);

  /// Equilibrium under the rail's weight and a vertical force at `place`, the coupled cells on their pads (`laws`, one
  /// per value) against sleepers held at `sleeper_displacement`. `contact_force` presses down [N].
  StaticState solve(const std::vector<proto::PadLaw>& laws, const Eigen::VectorXd& sleeper_displacement,
                    const BandWeights& place, double contact_force) const;

  /// g' K^-1 g of a load g on all degrees of freedom, the coupled cells free: of a unit force, its deflection [m/N].
  double flexibility(const Eigen::VectorXd& load) const { return load.dot(factor_.solve(load)); }

 private:
  const TrackSystem& system_;
  const RunningBand& band_;
  Cholesky factor_;
  Eigen::MatrixXd interface_columns_;  // K^-1 Phi'
};

}  // namespace fem
