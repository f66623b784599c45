#include "fem_solver/contact/running_band.hpp"

#include <string>

#include "proto/error.hpp"

namespace fem {

Eigen::VectorXd RunningBand::station_load(int station) const {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(n_dofs_);
  for (const auto& share : stations_[station]) load[share.dof] += share.weight;
  return load;
}

double RunningBand::read(const BandWeights& place, const Eigen::VectorXd& field) const {
  double value = 0.0;
  for (std::size_t j = 0; j < place.weights.size(); ++j)
    for (const auto& share : stations_[place.first_station + j])
      value += place.weights[j] * share.weight * field[share.dof];
  return value;
}

void RunningBand::add_load(const BandWeights& place, double force, Eigen::VectorXd& load) const {
  for (std::size_t j = 0; j < place.weights.size(); ++j)
    for (const auto& share : stations_[place.first_station + j])
      load[share.dof] += force * place.weights[j] * share.weight;
}

void RunningBand::refuse_end(double x) {
  throw proto::Error(
      proto::ExitCode::config,
      "the wheel at x = " + std::to_string(x) + " m comes within three elements of the refined rail's end",
      "wheel.start_m, wheel.speed_m_per_s, coupling.duration_s", "raise fem.n_bays or shorten the run");
}

}  // namespace fem
