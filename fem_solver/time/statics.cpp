#include "fem_solver/time/statics.hpp"

#include "fem_solver/time/interface_solve.hpp"

namespace fem {

Statics::Statics(const TrackSystem& system, const RunningBand& band)
    : system_(system), band_(band), factor_(system.rail_stiffness + system.support_stiffness, "rail at rest") {
  if (system.cells.rows() > 0) cell_columns_ = factor_.solve_columns(Eigen::MatrixXd(system.cells.transpose()));
}

StaticState Statics::solve(const std::vector<proto::PadLaw>& laws, const Eigen::VectorXd& sleeper_displacement,
                           const BandWeights& place, double contact_force) const {
  Eigen::VectorXd load = system_.weight;
  band_.add_load(place, -contact_force, load);
  StaticState state;
  state.displacement = factor_.solve(load);
  const Eigen::Index n = static_cast<Eigen::Index>(laws.size());
  state.pad_force = Eigen::VectorXd::Zero(n);
  if (n == 0) return state;

  InterfaceProblem p;
  p.laws = laws;
  p.gap_0 = system_.cells * state.displacement - sleeper_displacement;
  p.free_velocity = p.sleeper_velocity = p.carry = p.contact_column = Eigen::VectorXd::Zero(n);
  p.compliance = system_.cells * cell_columns_;
  p.time_factor = 1.0, p.rate_factor = 0.0;
  state.pad_force = solve_interface(p, {state.pad_force}, "fem: static state").force;
  state.displacement -= cell_columns_ * state.pad_force;
  return state;
}

}  // namespace fem
