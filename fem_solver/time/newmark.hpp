// Average-acceleration Newmark in momentum form, one factorisation for a constant step.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "fem_solver/assembly/track_system.hpp"
#include "fem_solver/linear/cholesky.hpp"

namespace fem {

/// Displacement, velocity and the internal force K u of all degrees of freedom.
struct TrackState {
  Eigen::VectorXd displacement;  ///< [m]
  Eigen::VectorXd velocity;      ///< [m/s]
  Eigen::VectorXd elastic;       ///< (K_r + K_s) u, carried along instead of being multiplied anew [N]
};

/// One step from u0, v0 to u1, v1 over H with the window mean of the load (coupling.md 4.3, beta = 1/4, gamma = 1/2):
///
///     A v_m = F_mean + 2 M v0/H - K u0,   A = 2 M/H + C + K H/2,   u1 = u0 + H v_m,   v1 = 2 v_m - v0
///
/// Loads that are linear in unknown scalars enter by superposition: v_m = response(known part) + columns * unknowns.
class Newmark {
 public:
  /// `mass_damping`: C gets mass_damping * M on top [1/s]. Throws proto::Error for a step that is not positive.
  Newmark(const TrackSystem& system, double step, double mass_damping);

  double step() const { return step_; }
  const Cholesky& factor() const { return factor_; }

  /// State at rest with displacement u; the internal force is multiplied out.
  TrackState state_at_rest(const Eigen::VectorXd& displacement) const;

  /// Right-hand side for a load known up to the unknown scalars.
  Eigen::VectorXd right_side(const TrackState& state, const Eigen::VectorXd& mean_load) const;

  /// A^-1 of a right-hand side or load.
  Eigen::VectorXd response(const Eigen::VectorXd& right_side) const { return factor_.solve(right_side); }

  /// Advances the state with the mean velocity that solves A v_m = right_side (unknown scalars now included).
  void finish(TrackState& state, const Eigen::VectorXd& mean_velocity, const Eigen::VectorXd& right_side) const;

  /// v'M v/2 + u'K u/2 [J].
  double energy(const TrackState& state) const;

 private:
  const TrackSystem& system_;
  double step_, mass_damping_;
  Cholesky factor_;
};

}  // namespace fem
