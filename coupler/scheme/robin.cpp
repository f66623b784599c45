#include "coupler/scheme/robin.hpp"

namespace coupler {

void RobinScheme::solve(WindowRecord& record, Sides sides) {
  pass(record, 0, predicted(), sides);
  if (!corrected_ || record.phase != proto::Phase::march) return;
  const double defect = raw_defect(record);
  const auto target = corrected(record);
  roll_back(record, sides);
  pass(record, 1, target, sides);
  record.solves = 2;
  record.contraction = defect > 0.0 ? raw_defect(record) / defect : 0.0;
}

void RobinScheme::pass(WindowRecord& record, std::uint32_t iteration, const RobinTarget& target, Sides sides) {
  solve_rail(record, robin_request(record, iteration, target), sides.implicit_side);
  record.force_law.resize(n_values());
  for (std::size_t i = 0; i < n_values(); ++i) {
    const double u0 = record.rail_displacement_begin[i], u1 = record.rail_displacement[i];
    record.force_law[i] =
        laws()[i].force((u0 + u1) / 2 - target.displacement[i], (u1 - u0) / window_s() - target.velocity[i]);
  }
  solve_sleeper(record, path_request(record, iteration), sides.explicit_side);
}

RobinTarget RobinScheme::predicted() const {
  const double h = window_s();
  RobinTarget target;
  for (std::size_t i = 0; i < n_values(); ++i) {
    const double y = state_.interface.sleeper_velocity[i], a = state_.sleeper_acceleration[i];
    target.displacement.push_back(state_.interface.sleeper_displacement[i] + h * y / 2 + h * h * a / 6);
    target.velocity.push_back(y + h * a / 2);
  }
  target.carry = state_.force_carry;
  return target;
}

RobinTarget RobinScheme::corrected(const WindowRecord& record) const {
  const double h = window_s();
  RobinTarget target;
  for (std::size_t i = 0; i < n_values(); ++i) {
    const double k = laws()[i].stiffness, c = laws()[i].damping, force = record.impulse[i] / h;
    const double u0 = record.rail_displacement_begin[i], u1 = record.rail_displacement[i];
    const double mean = (u0 + u1) / 2, rate = (u1 - u0) / h;
    double y = (record.sleeper_displacement[i] - state_.interface.sleeper_displacement[i]) / h;
    if (!(k > 0) && c > 0) y = rate - force / c;
    target.displacement.push_back(k > 0 ? mean - (force - c * (rate - y)) / k : mean);
    target.velocity.push_back(y);
  }
  target.carry = state_.force_carry;
  return target;
}

double RobinScheme::raw_defect(const WindowRecord& record) const {
  std::vector<double> defect = record.force_robin;
  for (std::size_t i = 0; i < defect.size(); ++i) defect[i] -= record.impulse[i] / window_s();
  return norm(defect);
}

}  // namespace coupler
