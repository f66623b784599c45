// The track at rest, and what the mesh adds to the wheel's contact compliance.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem_solver/assembly/rail_system.hpp"
#include "fem_solver/contact/head_band.hpp"
#include "fem_solver/linear/cholesky.hpp"
#include "proto/pad/pad_law.hpp"

namespace fem {

struct StaticState {
  Eigen::VectorXd displacement;  ///< all degrees of freedom [m]
  Eigen::VectorXd pad_force;     ///< on the sleepers at the coupled cells [N]
};

/// Static solutions on one factorisation of K_r + K_s; everything is computed in the constructor but the superposition.
class Statics {
 public:
  Statics(const RailSystem& system, const HeadBand& band);

  /// Equilibrium under the rail's weight and a vertical force at `place`, the coupled cells on their pads (`laws`, one
  /// per value) against sleepers held at `sleeper_displacement`. `contact_force` presses down [N].
  StaticState solve(const std::vector<proto::PadLaw>& laws, const Eigen::VectorXd& sleeper_displacement,
                    const BandWeights& place, double contact_force) const;

  /// Flexibility that the band's weights see beyond the rail as a beam: head under its own patch minus cross-section
  /// mean under a load spread over that cross-section, averaged over the stations of the middle bay [m/N]. A wheel's
  /// contact adds it back, so that local flattening is counted once, in the Hertz spring.
  double indentation() const { return indentation_; }

 private:
  const RailSystem& system_;
  const HeadBand& band_;
  Cholesky factor_;
  Eigen::MatrixXd cell_columns_;  // K^-1 Phi'
  double indentation_ = 0.0;
};

}  // namespace fem
