#include "coupler/scheme/window_scheme.hpp"

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

WindowScheme::WindowScheme(proto::Scheme scheme, double window_s, std::uint32_t sub_cycles,
                           std::vector<proto::PadLaw> laws)
    : scheme_(scheme), window_s_(window_s), sub_cycles_(sub_cycles), laws_(std::move(laws)) {
  const std::vector<double> zero(laws_.size(), 0.0);
  start({zero, zero, zero, zero});
  rail_known_ = false;
}

void WindowScheme::start(const InterfaceState& initial) {
  const std::size_t n = laws_.size();
  expect_length(initial.rail_displacement, field::rail_displacement, n);
  expect_length(initial.rail_velocity, field::rail_velocity, n);
  expect_length(initial.sleeper_displacement, field::sleeper_displacement, n);
  expect_length(initial.sleeper_velocity, field::sleeper_velocity, n);
  state_ = initial;
  rail_known_ = true;
  sleeper_acceleration_.assign(n, 0.0);
  force_carry_.assign(n, 0.0);
  force_mean_.resize(n);
  // The mean force "of the windows before the first" is the pad's force at the initial values.
  for (std::size_t i = 0; i < n; ++i)
    force_mean_[i] = laws_[i].force(state_.rail_displacement[i] - state_.sleeper_displacement[i],
                                    state_.rail_velocity[i] - state_.sleeper_velocity[i]);
  force_mean_before_ = force_mean_;
}

void WindowScheme::predict_sleeper(std::vector<double>& mean_displacement, std::vector<double>& mean_velocity) const {
  const double h = window_s_;
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const double y = state_.sleeper_velocity[i], a = sleeper_acceleration_[i];
    mean_displacement.push_back(state_.sleeper_displacement[i] + h * y / 2 + h * h * a / 6);
    mean_velocity.push_back(y + h * a / 2);
  }
}

std::vector<double> WindowScheme::expected_force() const {
  std::vector<double> force = force_mean_;
  if (scheme_ == proto::Scheme::serial_extrapolated) {
    for (std::size_t i = 0; i < force.size(); ++i) force[i] += force_mean_[i] - force_mean_before_[i];
  }
  return force;
}

proto::Advance WindowScheme::implicit_request(proto::Phase phase, std::int64_t window) const {
  proto::Advance request{phase, window, 0, window_s_, 1, {}};
  if (!proto::uses_robin(scheme_)) {
    request.data.set(field::force_mean, expected_force());
    return request;
  }
  std::vector<double> displacement, velocity;
  predict_sleeper(displacement, velocity);
  set_robin(request, std::move(displacement), std::move(velocity));
  return request;
}

void WindowScheme::set_robin(proto::Advance& request, std::vector<double> displacement,
                             std::vector<double> velocity) const {
  request.data.set(field::sleeper_mean_displacement, std::move(displacement));
  request.data.set(field::sleeper_mean_velocity, std::move(velocity));
  request.data.set(field::force_carry, force_carry_);
}

proto::Advance WindowScheme::corrected_request(const WindowRecord& record) const {
  const double h = window_s_;
  std::vector<double> displacement, velocity;
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    const double k = laws_[i].stiffness, c = laws_[i].damping, force = record.impulse[i] / h;
    const double u0 = record.rail_displacement_begin[i], u1 = record.rail_displacement[i];
    const double mean = (u0 + u1) / 2, rate = (u1 - u0) / h;
    double y = (record.sleeper_displacement[i] - state_.sleeper_displacement[i]) / h;
    if (!(k > 0) && c > 0) y = rate - force / c;
    displacement.push_back(k > 0 ? mean - (force - c * (rate - y)) / k : mean);
    velocity.push_back(y);
  }
  proto::Advance request{record.phase, record.window, 1, h, 1, {}};
  set_robin(request, std::move(displacement), std::move(velocity));
  return request;
}

proto::Advance WindowScheme::explicit_request(const WindowRecord& record, std::uint32_t iteration) const {
  proto::Advance request{record.phase, record.window, iteration, window_s_, record.sub_cycles, {}};
  request.data.set(field::rail_displacement_begin, record.rail_displacement_begin);
  request.data.set(field::rail_displacement, record.rail_displacement);
  request.data.set(field::rail_velocity_begin, rail_known_ ? state_.rail_velocity : record.rail_velocity);
  request.data.set(field::rail_velocity, record.rail_velocity);
  return request;
}

void WindowScheme::solve_implicit(WindowRecord& record, const proto::Advance& request, Side& side) const {
  const std::size_t n = laws_.size();
  const auto rail = side.advance(request);
  record.implicit_compute_s += rail.compute_s;
  record.implicit_residual = rail.residual.value_or(0.0);
  record.rail_displacement = take(rail, "fem", field::rail_displacement, n);
  record.rail_velocity = take(rail, "fem", field::rail_velocity, n);
  record.force_used = take(rail, "fem", field::force_used, n);
  record.force_robin = proto::uses_robin(scheme_) ? take(rail, "fem", field::force_robin, n) : record.force_used;
  // The initialise phase begins before any value was exchanged: the rail is taken to have stood where it is found, so
  // that the pad gets no blow from a displacement that was there all along.
  record.rail_displacement_begin = rail_known_ ? state_.rail_displacement : record.rail_displacement;
}

void WindowScheme::solve_explicit(WindowRecord& record, const proto::Advance& request, Side& side) {
  const std::size_t n = laws_.size();
  const auto sleeper = side.advance(request);
  record.explicit_compute_s += sleeper.compute_s;
  record.explicit_residual = sleeper.residual.value_or(0.0);
  record.impulse = take(sleeper, "qdem", field::impulse, n);
  record.pad_work = take(sleeper, "qdem", field::pad_work, n);
  record.sleeper_displacement = take(sleeper, "qdem", field::sleeper_displacement, n);
  record.sleeper_velocity = take(sleeper, "qdem", field::sleeper_velocity, n);
  if (sleeper.largest_step_s) sub_cycles_ = sub_cycles_for(window_s_, sleeper.largest_step_s);
}

WindowRecord WindowScheme::advance(proto::Phase phase, std::int64_t window, Sides sides) {
  WindowRecord record;
  record.phase = phase;
  record.window = window;
  record.sub_cycles = sub_cycles_;
  solve_implicit(record, implicit_request(phase, window), sides.implicit_side);
  solve_explicit(record, explicit_request(record, 0), sides.explicit_side);
  if (scheme_ == proto::Scheme::robin_corrected && phase == proto::Phase::march) {
    const auto corrected = corrected_request(record);
    sides.implicit_side.rollback({window});
    sides.explicit_side.rollback({window});
    solve_implicit(record, corrected, sides.implicit_side);
    solve_explicit(record, explicit_request(record, 1), sides.explicit_side);
  }
  update(record);
  return record;
}

void WindowScheme::update(const WindowRecord& record) {
  force_mean_before_ = force_mean_;
  for (std::size_t i = 0; i < laws_.size(); ++i) {
    sleeper_acceleration_[i] = (record.sleeper_velocity[i] - state_.sleeper_velocity[i]) / window_s_;
    force_mean_[i] = record.impulse[i] / window_s_;
    force_carry_[i] = record.force_robin[i] - force_mean_[i];
  }
  state_ = {record.rail_displacement, record.rail_velocity, record.sleeper_displacement, record.sleeper_velocity};
  rail_known_ = true;
}

void WindowScheme::exchange(proto::StateArchive& archive) {
  archive.expect_same("scheme/name", "the scheme", proto::name_of(scheme_));
  const auto list = [&](const char* name, std::vector<double>& values) {
    archive(std::string("scheme/") + name, values);
    archive.expect_length(name, values.size(), laws_.size());
  };
  list("rail_displacement", state_.rail_displacement);
  list("rail_velocity", state_.rail_velocity);
  list("sleeper_displacement", state_.sleeper_displacement);
  list("sleeper_velocity", state_.sleeper_velocity);
  list("sleeper_acceleration", sleeper_acceleration_);
  list("force_carry", force_carry_);
  list("force_mean", force_mean_);
  list("force_mean_before", force_mean_before_);
  archive("scheme/sub_cycles", sub_cycles_);
  archive("scheme/rail_known", rail_known_);
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
