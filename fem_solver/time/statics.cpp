#include "fem_solver/time/statics.hpp"

#include "fem_solver/time/interface_solve.hpp"

namespace fem {

Statics::Statics(const TrackSystem& system, const RunningBand& band)
    : system_(system), band_(band), factor_(system.rail_stiffness + system.support_stiffness, "rail at rest") {
  if (system.interface.rows() > 0)
    interface_columns_ = factor_.solve_columns(Eigen::MatrixXd(system.interface.transpose()));
}

StaticState Statics::solve(const std::vector<proto::PadLaw>& laws, const Eigen::VectorXd& sleeper_displacement,
                           const BandWeights& place, double contact_force) const {
  Eigen::VectorXd load = system_.weight;
  band_.add_load(place, -contact_force, load);
  StaticState state;
  state.displacement = factor_.solve(load);
  const auto n_coupled = static_cast<Eigen::Index>(laws.size()), n_cells = system_.cells.rows();
  const Eigen::Index n_supports = system_.interface.rows() - n_cells, n = n_coupled + n_supports;
  state.pad_force = Eigen::VectorXd::Zero(n);
  if (n == 0) return state;
  // Without laws the coupled cells are free.
  const SparseMatrix rows = system_.interface.bottomRows(n);
  const auto columns = interface_columns_.rightCols(n);

  InterfaceProblem p;
  p.laws = interface_laws_of(laws);
  p.laws.insert(p.laws.end(), system_.support_laws.begin(), system_.support_laws.end());
  p.gap_0 = rows * state.displacement;
  p.gap_0.head(n_coupled) -= sleeper_displacement;
  p.free_velocity = p.sleeper_velocity = p.carry = p.contact_column = Eigen::VectorXd::Zero(n);
  p.compliance = rows * columns;
  p.time_factor = 1.0, p.rate_factor = 0.0;
  state.pad_force = solve_interface(p, {state.pad_force}, "fem: static state").force;
  state.displacement -= columns * state.pad_force;
  return state;
}

}  // namespace fem
