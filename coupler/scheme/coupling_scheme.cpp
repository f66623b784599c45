#include "coupler/scheme/coupling_scheme.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "proto/error.hpp"

namespace coupler {
namespace {

namespace field = proto::field;

std::vector<double> take(const proto::Result& result, const std::string& side, const std::string& name, std::size_t n) {
  if (!result.data.has(name))
    throw proto::Error(proto::ExitCode::protocol, side + " did not return the field '" + name + "'",
                       "window " + std::to_string(result.window), "see proto/README.md for the fields of a result");
  const auto& values = result.data.get(name);
  if (values.size() != n)
    throw proto::Error(proto::ExitCode::protocol,
                       side + " returned " + std::to_string(values.size()) + " values of '" + name + "' instead of " +
                           std::to_string(n),
                       "window " + std::to_string(result.window));
  return values;
}

void expect_length(const std::vector<double>& values, const char* name, std::size_t n) {
  if (values.size() != n)
    throw proto::Error(proto::ExitCode::protocol, "the initial values of '" + std::string(name) + "' have length " +
                                                      std::to_string(values.size()) + " instead of " +
                                                      std::to_string(n));
}

}  // namespace

double norm(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

CouplingScheme::CouplingScheme(SchemeSetup setup) : setup_(std::move(setup)) {
  const std::vector<double> zero(n_values(), 0.0);
  state_.sub_cycles = setup_.sub_cycles * setup_.sub_cycle_factor;
  start({zero, zero, zero, zero});
  state_.rail_known = false;
}

void CouplingScheme::start(const InterfaceState& initial) {
  const std::size_t n = n_values();
  expect_length(initial.rail_displacement, field::rail_displacement, n);
  expect_length(initial.rail_velocity, field::rail_velocity, n);
  expect_length(initial.sleeper_displacement, field::sleeper_displacement, n);
  expect_length(initial.sleeper_velocity, field::sleeper_velocity, n);
  SchemeState fresh;
  fresh.sub_cycles = state_.sub_cycles;
  fresh.interface = initial;
  fresh.rail_known = true;
  fresh.sleeper_acceleration.assign(n, 0.0);
  fresh.force_carry.assign(n, 0.0);
  // The mean force "of the windows before the first" is the pad's force at the initial values.
  for (std::size_t i = 0; i < n; ++i)
    fresh.force_mean.push_back(laws()[i].force(initial.rail_displacement[i] - initial.sleeper_displacement[i],
                                               initial.rail_velocity[i] - initial.sleeper_velocity[i]));
  fresh.force_mean_before = fresh.force_mean;
  state_ = std::move(fresh);
}

proto::Advance CouplingScheme::force_request(const WindowRecord& record, std::uint32_t iteration,
                                             std::vector<double> force) const {
  proto::Advance request{record.phase, record.window, iteration, window_s(), 1, {}};
  request.data.set(field::force_mean, std::move(force));
  return request;
}

proto::Advance CouplingScheme::robin_request(const WindowRecord& record, std::uint32_t iteration,
                                             RobinTarget target) const {
  proto::Advance request{record.phase, record.window, iteration, window_s(), 1, {}};
  request.data.set(field::sleeper_mean_displacement, std::move(target.displacement));
  request.data.set(field::sleeper_mean_velocity, std::move(target.velocity));
  request.data.set(field::force_carry, std::move(target.carry));
  return request;
}

proto::Advance CouplingScheme::path_request(const WindowRecord& record, std::uint32_t iteration) const {
  const auto& velocity_begin = state_.rail_known ? state_.interface.rail_velocity : record.rail_velocity;
  proto::Advance request{record.phase, record.window, iteration, window_s(), record.sub_cycles, {}};
  request.data.set(field::rail_displacement_begin, record.rail_displacement_begin);
  request.data.set(field::rail_displacement, record.rail_displacement);
  request.data.set(field::rail_velocity_begin, velocity_begin);
  request.data.set(field::rail_velocity, record.rail_velocity);
  if (setup_.prolongation == proto::Prolongation::hermite) {
    request.data.set(field::path_velocity_begin, velocity_begin);
    request.data.set(field::path_velocity, record.rail_velocity);
  }
  return request;
}

void CouplingScheme::take_rail(WindowRecord& record, const proto::Result& rail) const {
  const std::size_t n = n_values();
  record.implicit_compute_s += rail.compute_s;
  record.implicit_residual = rail.residual.value_or(0.0);
  record.rail_displacement = take(rail, "fem", field::rail_displacement, n);
  record.rail_velocity = take(rail, "fem", field::rail_velocity, n);
  record.force_used = take(rail, "fem", field::force_used, n);
  // The initialise phase begins before any value was exchanged: the rail is taken to have stood where it is found, so
  // that the pad gets no blow from a displacement that was there all along.
  record.rail_displacement_begin = state_.rail_known ? state_.interface.rail_displacement : record.rail_displacement;
}

void CouplingScheme::solve_rail(WindowRecord& record, const proto::Advance& request, Side& side) const {
  const auto rail = side.advance(request);
  take_rail(record, rail);
  const bool robin = request.data.has(field::force_carry);
  record.force_robin = robin ? take(rail, "fem", field::force_robin, n_values()) : record.force_used;
}

void CouplingScheme::take_sleeper(WindowRecord& record, const proto::Result& sleeper) {
  const std::size_t n = n_values();
  record.explicit_compute_s += sleeper.compute_s;
  record.explicit_residual = sleeper.residual.value_or(0.0);
  record.impulse = take(sleeper, "qdem", field::impulse, n);
  record.pad_work = take(sleeper, "qdem", field::pad_work, n);
  record.sleeper_displacement = take(sleeper, "qdem", field::sleeper_displacement, n);
  record.sleeper_velocity = take(sleeper, "qdem", field::sleeper_velocity, n);
  if (sleeper.largest_step_s) take_step(*sleeper.largest_step_s);
}

void CouplingScheme::take_step(double largest_step_s) {
  const auto needed = sub_cycles_for(window_s(), largest_step_s);
  if (!setup_.fixed_sub_cycles) {
    state_.sub_cycles = needed * setup_.sub_cycle_factor;
  } else if (needed > state_.sub_cycles) {
    throw proto::Error(proto::ExitCode::numerics,
                       "qdem needs " + std::to_string(needed) + " sub-cycles now, a rigid joint keeps its first " +
                           std::to_string(state_.sub_cycles),
                       "", "raise coupling.sub_cycle_factor");
  }
}

void CouplingScheme::solve_sleeper(WindowRecord& record, const proto::Advance& request, Side& side) {
  take_sleeper(record, side.advance(request));
}

void CouplingScheme::roll_back(const WindowRecord& record, Sides sides) {
  sides.implicit_side.rollback({record.window});
  sides.explicit_side.rollback({record.window});
}

WindowRecord CouplingScheme::advance(proto::Phase phase, std::int64_t window, Sides sides) {
  WindowRecord record;
  record.phase = phase;
  record.window = window;
  record.sub_cycles = state_.sub_cycles;
  solve(record, sides);
  update(record);
  return record;
}

void CouplingScheme::commit(std::int64_t window, Sides sides) const {
  sides.implicit_side.commit({window});
  sides.explicit_side.commit({window});
}

void CouplingScheme::update(const WindowRecord& record) {
  const double h = window_s();
  state_.force_mean_before = state_.force_mean;
  for (std::size_t i = 0; i < n_values(); ++i) {
    state_.sleeper_acceleration[i] = (record.sleeper_velocity[i] - state_.interface.sleeper_velocity[i]) / h;
    state_.force_mean[i] = record.impulse[i] / h;
    state_.force_carry[i] = record.force_robin[i] - state_.force_mean[i];
  }
  state_.force_scale = std::max(state_.force_scale, norm(state_.force_mean));
  state_.displacement_scale = std::max(state_.displacement_scale, norm(record.rail_displacement));
  state_.interface = {record.rail_displacement, record.rail_velocity, record.sleeper_displacement,
                      record.sleeper_velocity};
  state_.rail_known = true;
}

std::vector<double> extrapolated_force(const SchemeState& state) {
  std::vector<double> force = state.force_mean;
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += state.force_mean[i] - state.force_mean_before[i];
  return force;
}

std::uint32_t sub_cycles_for(double window_s, std::optional<double> largest_step_s) {
  if (!largest_step_s) return 1;
  const double limit = *largest_step_s;
  // A limit that is a whole fraction of the window but for round-off must not cost one more sub-cycle.
  const double wanted = limit > 0.0 ? std::ceil(window_s / limit * (1.0 - 1e-12)) : 0.0;
  if (!(wanted >= 1.0 && wanted <= 1e6))
    throw proto::Error(proto::ExitCode::numerics,
                       "the largest stable step of qdem is " + std::to_string(limit) + " s, the window " +
                           std::to_string(window_s) + " s",
                       "sub-cycles", "a step between a millionth of the window and infinity is wanted");
  return static_cast<std::uint32_t>(wanted);
}

}  // namespace coupler
