#include "fem_solver/time/statics.hpp"

#include "fem_solver/time/interface_solve.hpp"

namespace fem {
namespace {

// Force spread over the cross-section of one plane, vertical; as a row the mean vertical displacement of the section.
Eigen::VectorXd section_load(const RailSystem& system, int plane) {
  const NodeWeights mean = system.mesh->section_mean(plane);
  Eigen::VectorXd load = Eigen::VectorXd::Zero(system.n_dofs());
  for (std::size_t k = 0; k < mean.nodes.size(); ++k) load[3 * mean.nodes[k] + 2] = mean.weights[k];
  return load;
}

double mean_indentation(const RailSystem& system, const HeadBand& band, const Cholesky& factor) {
  const int middle = static_cast<int>(system.mesh->planes().size()) / 2, n = system.planes_per_bay;
  double sum = 0.0;
  for (int plane = middle; plane < middle + n; ++plane) {
    const auto place = band.at(system.mesh->planes()[plane]);
    Eigen::VectorXd patch = Eigen::VectorXd::Zero(system.n_dofs());
    band.add_load(place, 1.0, patch);
    const Eigen::VectorXd section = section_load(system, plane);
    sum += patch.dot(factor.solve(patch)) - section.dot(factor.solve(section));
  }
  return sum / n;
}

}  // namespace

Statics::Statics(const RailSystem& system, const HeadBand& band)
    : system_(system), band_(band), factor_(system.rail_stiffness + system.support_stiffness, "rail at rest") {
  if (system.cells.rows() > 0) cell_columns_ = factor_.solve_columns(Eigen::MatrixXd(system.cells.transpose()));
  indentation_ = mean_indentation(system, band, factor_);
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
  state.pad_force = solve_interface(p, {state.pad_force, 0.0, 0}, "fem: static state").force;
  state.displacement -= cell_columns_ * state.pad_force;
  return state;
}

}  // namespace fem
