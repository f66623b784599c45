#include "fem_solver/time/newmark.hpp"

#include "proto/error.hpp"

namespace fem {
namespace {

SparseMatrix system_matrix(const TrackSystem& s, double step, double mass_damping) {
  if (!(step > 0)) throw proto::Error(proto::ExitCode::config, "the window is not positive", "coupling.window_s");
  SparseMatrix a = (s.stiffness_damping + step / 2) * s.rail_stiffness;
  a += SparseMatrix(step / 2 * s.support_stiffness + s.support_damping);
  return a + (2 / step + mass_damping) * s.mass;
}

}  // namespace

Newmark::Newmark(const TrackSystem& system, double step, double mass_damping)
    : system_(system),
      step_(step),
      mass_damping_(mass_damping),
      factor_(system_matrix(system, step, mass_damping), "rail in motion") {}

TrackState Newmark::state_at_rest(const Eigen::VectorXd& displacement) const {
  return {displacement, Eigen::VectorXd::Zero(displacement.size()),
          symmetric(system_.rail_stiffness) * displacement + symmetric(system_.support_stiffness) * displacement};
}

Eigen::VectorXd Newmark::right_side(const TrackState& state, const Eigen::VectorXd& mean_load) const {
  const Eigen::VectorXd momentum = symmetric(system_.mass) * state.velocity;
  return mean_load + 2 / step_ * momentum - state.elastic;
}

void Newmark::finish(TrackState& state, const Eigen::VectorXd& mean_velocity, const Eigen::VectorXd& right_side) const {
  // K_r v_m follows from A v_m = right_side, which saves the product with the largest matrix.
  const Eigen::VectorXd support = symmetric(system_.support_stiffness) * mean_velocity;
  const Eigen::VectorXd momentum = symmetric(system_.mass) * mean_velocity;
  const Eigen::VectorXd rail = (right_side - (2 / step_ + mass_damping_) * momentum -
                                symmetric(system_.support_damping) * mean_velocity - step_ / 2 * support) /
                               (system_.stiffness_damping + step_ / 2);
  state.elastic += step_ * (rail + support);
  state.displacement += step_ * mean_velocity;
  state.velocity = 2 * mean_velocity - state.velocity;
}

double Newmark::energy(const TrackState& state) const {
  const Eigen::VectorXd momentum = symmetric(system_.mass) * state.velocity;
  return (state.velocity.dot(momentum) + state.displacement.dot(state.elastic)) / 2;
}

}  // namespace fem
