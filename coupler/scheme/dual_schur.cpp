#include "coupler/scheme/dual_schur.hpp"

#include <Eigen/QR>

#include "proto/error.hpp"

namespace coupler {
namespace {

namespace field = proto::field;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Vector = Eigen::VectorXd;

Eigen::Map<const Vector> map(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

Eigen::Map<const Matrix> map(const std::vector<double>& values, std::size_t n) {
  return {values.data(), static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n)};
}

/// Values of the interface that neither side can move have no force: the solution of least norm.
std::vector<double> solve_joint(const Matrix& both, const Vector& gap) {
  const Vector force = both.completeOrthogonalDecomposition().solve(gap);
  return {force.data(), force.data() + force.size()};
}

}  // namespace

proto::Advance DualSchur::joint_request(std::int64_t window, std::uint32_t iteration, const Values& begin,
                                        const Values& end, double window_s, std::uint32_t sub_cycles) const {
  proto::Advance request{proto::Phase::march, window, iteration, window_s, sub_cycles, {}};
  request.data.set(field::joint_force_begin, begin);
  request.data.set(field::joint_force, end);
  return request;
}

void DualSchur::probe(const WindowRecord& record, Sides sides, const SleeperWindow& fine) {
  probes_ = 0;
  if (record.phase != proto::Phase::march)
    throw proto::Error(proto::ExitCode::config, "a rigid joint has no initialise phase", "coupling.scheme",
                       "remove [coupling.initialise] from the case");
  if (!state_.joint.force.empty()) return;
  const std::size_t n = n_values();
  const Values zero(n, 0.0);
  const auto answer = [&](const Values& begin, const Values& end, Values& rail, Values& sleeper) {
    rail = sides.implicit_side.advance(joint_request(record.window, probes_, begin, end, window_s(), 1))
               .data.get(field::rail_velocity);
    sleeper =
        sides.explicit_side.advance(joint_request(fine.number, probes_, begin, end, fine.length_s, fine.sub_cycles))
            .data.get(field::sleeper_velocity);
    sides.implicit_side.rollback({record.window});
    sides.explicit_side.rollback({fine.number});
    ++probes_;
  };
  Values rail_free, sleeper_free, rail, sleeper;
  answer(zero, zero, rail_free, sleeper_free);
  Matrix rail_ramp(n, n), sleeper_ramp(n, n), acceleration(n, n);
  for (std::size_t j = 0; j < n; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    Values unit = zero;
    unit[j] = 1.0;
    answer(zero, unit, rail, sleeper);
    rail_ramp.col(column) = map(rail) - map(rail_free);
    sleeper_ramp.col(column) = map(sleeper) - map(sleeper_free);
    answer(unit, unit, rail, sleeper);
    acceleration.col(column) =
        (map(sleeper) - map(sleeper_free)) / fine.length_s - (map(rail) - map(rail_free)) / window_s();
  }
  const Vector gap = (map(rail_free) - map(state_.interface.rail_velocity)) / window_s() -
                     (map(sleeper_free) - map(state_.interface.sleeper_velocity)) / fine.length_s;
  state_.joint.force = solve_joint(acceleration, gap);
  state_.joint.rail_operator.assign(rail_ramp.data(), rail_ramp.data() + n * n);
  state_.joint.sleeper_operator.assign(sleeper_ramp.data(), sleeper_ramp.data() + n * n);
}

DualSchur::Values DualSchur::correction(const Values& rail_velocity, const Values& sleeper_velocity) const {
  const Matrix both = map(state_.joint.sleeper_operator, n_values()) - map(state_.joint.rail_operator, n_values());
  return solve_joint(both, map(rail_velocity) - map(sleeper_velocity));
}

void RigidPerWindow::solve(WindowRecord& record, Sides sides) {
  probe(record, sides, {record.window, window_s(), record.sub_cycles});
  const Values begin = state_.joint.force;
  Values end = begin;
  const auto pass = [&](std::uint32_t iteration) {
    const auto rail = joint_request(record.window, iteration, begin, end, window_s(), 1);
    solve_rail(record, rail, sides.implicit_side);
    const auto sleeper = joint_request(record.window, iteration, begin, end, window_s(), record.sub_cycles);
    solve_sleeper(record, sleeper, sides.explicit_side);
  };
  pass(probes_);
  const auto change = correction(record.rail_velocity, record.sleeper_velocity);
  for (std::size_t i = 0; i < end.size(); ++i) end[i] += change[i];
  roll_back(record, sides);
  pass(probes_ + 1);
  record.solves = 2;
  state_.joint.force = end;
}

void RigidPerStep::solve(WindowRecord& record, Sides sides) {
  const std::size_t n = n_values();
  probe(record, sides, {record.window * record.sub_cycles, window_s() / record.sub_cycles, 1});
  const std::uint32_t first = probes_;
  const Values begin = state_.joint.force, zero(n, 0.0);
  // Free: without the force at the end of the window (of the window before, for its begin).
  const Vector free_begin = map(state_.interface.rail_velocity) - map(state_.joint.rail_operator, n) * map(begin);
  solve_rail(record, joint_request(record.window, first, begin, zero, window_s(), 1), sides.implicit_side);
  const Values free_end = record.rail_velocity;
  sides.implicit_side.rollback({record.window});
  const Values end =
      sub_steps(record, {free_begin.data(), free_begin.data() + free_begin.size()}, free_end, sides.explicit_side);
  solve_rail(record, joint_request(record.window, first + 1, begin, end, window_s(), 1), sides.implicit_side);
  record.solves = 2;
  state_.joint.force = end;
}

DualSchur::Values RigidPerStep::sub_steps(WindowRecord& record, const Values& free_begin, const Values& free_end,
                                          Side& sleeper) {
  const std::size_t n = n_values();
  const double step = window_s() / record.sub_cycles;
  Values force = state_.joint.force, impulse(n, 0.0), work(n, 0.0), interpolated(n);
  for (std::uint32_t j = 1; j <= record.sub_cycles; ++j) {
    const std::int64_t fine = record.window * record.sub_cycles + j - 1;
    const std::uint32_t iteration = j == 1 ? probes_ : 0;
    const double s = static_cast<double>(j) / record.sub_cycles;
    for (std::size_t i = 0; i < n; ++i) interpolated[i] = (1 - s) * free_begin[i] + s * free_end[i];
    solve_sleeper(record, joint_request(fine, iteration, force, Values(n, 0.0), step, 1), sleeper);
    const auto next = correction(interpolated, record.sleeper_velocity);
    sleeper.rollback({fine});
    solve_sleeper(record, joint_request(fine, iteration + 1, force, next, step, 1), sleeper);
    for (std::size_t i = 0; i < n; ++i) impulse[i] += record.impulse[i], work[i] += record.pad_work[i];
    if (j < record.sub_cycles) sleeper.commit({fine});
    force = next;
  }
  record.impulse = impulse;
  record.pad_work = work;
  return force;
}

void RigidPerStep::commit(std::int64_t window, Sides sides) const {
  sides.implicit_side.commit({window});
  sides.explicit_side.commit({(window + 1) * state_.sub_cycles - 1});
}

}  // namespace coupler
