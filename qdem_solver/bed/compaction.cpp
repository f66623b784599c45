// The part of a Builder that moves the scene: tamping, hardening, consolidation, rest.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "proto/clock.hpp"
#include "qdem_solver/bed/builder.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/relaxation.hpp"
#include "qdem_solver/engine/stability.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

constexpr double step_safety = 0.8;
constexpr int touching_points = 10;  // of a stone while it may fall on others, for the step and the inertia
constexpr int steps_per_fit = 50;    // inertia is fitted to the contacts anew
constexpr int steps_per_look = 25;
constexpr int least_true_steps = 500, most_true_steps = 4000;  // at true masses, at the end

constexpr double damping = 0.5;           // Cundall's
constexpr double contact_damping = 0.03;  // a ratio; rest does not depend on it, the relaxation's step does
constexpr double pouring_skin = 0.08;     // candidate lists live longer while stones move [d50]
constexpr double tamping_speed = 0.2;     // [m/s]
constexpr double tamped_speed = 0.02;     // [m/s], below which a tamped layer is at rest
constexpr double parting_time = 0.1;      // [s], in which stones that overlap part
constexpr double settling_time = 1.0;     // [s], at most
constexpr double settling_drag = 30;      // [1/s]
constexpr double rolling_drag = 5;        // [1/s], while stones of the shoulder roll down
constexpr double calm_speed = 1e-3;       // [m/s], root mean square over the mass, before the bed is made harder
constexpr double hardening_drag = 1.0;    // of the rattling frequency of a mean stone on one contact
constexpr double heaved_share = 0.95;     // of the sleeper's weight; drag would keep a heavy sleeper down
constexpr double share_of_limits = 0.5;   // rest is better than the case asks for
constexpr double telling_interval = 5;    // [s] of work

using proto::seconds_since;

}  // namespace

void Builder::soften(const Softness& softness) {
  const double share = softness.young / physics_.stone.young;
  model_.materials = physics_.materials();
  for (Material& material : model_.materials) {
    material.young *= share;
    material.lame_viscosity *= share;  // keeps the retardation time
    material.shear_viscosity *= share;
  }
  model_.contact = physics_.contact;
  model_.contact.normal_stiffness = softness.stiffness;
  model_.contact.friction = softness.friction;
  if (falling_) model_.contact.skin = pouring_skin * settings_.gradation.size_at(0.5);
  model_.contact.damping_ratio = contact_damping;
  model_.local_damping = softness.local_damping;
  model_.drag_per_s = softness.drag;
}

void Builder::run(const Duration& duration, const Rest& rest, const Look& look) {
  Relaxation relaxation(model_, contact_points(), step_safety);
  Engine engine(model_);
  relaxation.begin(engine, state_);
  march(engine, relaxation.step(), duration, rest, [&](double elapsed) {
    if (state_.step % steps_per_fit == 0) relaxation.fit(engine, state_);
    return look && look(elapsed);
  });
  model_.inertia.clear();
}

int Builder::contact_points() const {
  return falling_ ? touching_points : resting_points;
}

void Builder::run_with_true_masses(int least_steps, int most_steps, const Rest& rest) {
  model_.inertia.assign(model_.bodies.size(), Inertia{});
  Engine engine(model_);
  engine.prepare(state_);
  const double dt = step_safety * StepBound(model_).at(state_, engine.contacts(), near_gap(model_.contact));
  march(engine, dt, {least_steps * dt, most_steps * dt}, rest, {});
  model_.inertia.clear();
}

void Builder::march(Engine& engine, double dt, const Duration& duration, const Rest& rest, const Look& look) {
  const auto clock = std::chrono::steady_clock::now();
  auto told = clock;
  const auto first_step = state_.step;
  const double start = state_.time, mass = mass_of_stones();
  while (state_.time - start < duration.most) {
    engine.advance(state_, dt, steps_per_look);
    if (look && look(state_.time - start)) break;
    if (seconds_since(told) > telling_interval) {
      told = std::chrono::steady_clock::now();
      spdlog::info("bed: {}, {} steps, unbalanced force {:.1e}, kinetic energy {:.1e} J", stage_,
                   state_.step - first_step, engine.unbalanced_ratio(state_), engine.kinetic_energy(state_));
    }
    if (state_.time - start < duration.least) continue;
    const double kinetic = engine.kinetic_energy(state_);
    const bool slow = rest.speed > 0 && std::sqrt(2 * kinetic / mass) < rest.speed;
    const bool still = rest.kinetic > 0 && kinetic < rest.kinetic && engine.unbalanced_ratio(state_) < rest.unbalanced;
    if (slow || still) break;
  }
  report_.kinetic_energy = engine.kinetic_energy(state_);
  report_.unbalanced_force_ratio = engine.unbalanced_ratio(state_);
  const ContactReport contacts = engine.contacts().report(state_);
  report_.coordination_number = contacts.coordination_number;
  report_.largest_penetration = contacts.largest_penetration;
  spdlog::info(
      "bed: {}: {:.3f} s in {} steps of {:.2f} us ({:.1f} s of work), unbalanced force {:.1e}, kinetic energy {:.1e} "
      "J, {} contacts, penetration {:.3f} mm, sleeper at {:.3f} mm",
      stage_, state_.time - start, state_.step - first_step, 1e6 * dt, seconds_since(clock),
      report_.unbalanced_force_ratio, report_.kinetic_energy, contacts.live, 1e3 * report_.largest_penetration,
      1e3 * seat_height());
}

double Builder::tamp(double level, double pressure) {
  const double start = std::max(top_of_stones(), level) + physics_.contact.rounding;
  const double area = settings_.wall() * settings_.spacing;
  model_.planes.push_back({"tamp",
                           {0, 0, start + tamping_speed * state_.time},
                           -Vector3d::UnitZ(),
                           Vector3d(0, 0, -tamping_speed),
                           0.0,
                           true,
                           false});
  drop_contacts();
  const auto place = [this] { return model_.planes.back().point[2] + state_.time * model_.planes.back().velocity[2]; };
  // Pressed until the level is reached or the pressure is: what remains above was too much for this porosity.
  run({0, (start - level) / tamping_speed}, {}, [&](double) { return pressure_on(place(), area) > pressure; });
  const double reached = std::max(place(), level);
  model_.planes.back().velocity.setZero();
  model_.planes.back().point[2] = reached;
  drop_contacts();
  run({0.02, 0.1}, {tamped_speed});
  model_.planes.pop_back();
  drop_contacts();
  return reached;
}

double Builder::pressure_on(double level, double area) const {
  double force = 0.0;
  for (int b = 1; b < static_cast<int>(model_.bodies.size()); ++b) {
    for (const int node : model_.shape(b).surface_nodes) {
      const double overlap = state_.position(model_, b, node)[2] + physics_.contact.rounding - level;
      force += model_.contact.normal_stiffness * std::max(0.0, overlap);
    }
  }
  return force / area;
}

Builder::Softness Builder::at_level(int level) const {
  const Settings& s = settings_;
  const double share = static_cast<double>(level) / s.ramp_levels;
  const double stiffness = s.pour_stiffness * std::pow(physics_.contact.normal_stiffness / s.pour_stiffness, share);
  return {s.pour_young * std::pow(physics_.stone.young / s.pour_young, share), stiffness, s.pour_friction, damping,
          settling_drag};
}

void Builder::settle() {
  stage_ = "settling", falling_ = false;
  hold_sleeper(held_along_track);
  drop_contacts();
  soften(at_level(settling_level()));
  run({parting_time, parting_time});
  model_.drag_per_s = rolling_drag;
  run({0, settling_time}, {calm_speed});
}

void Builder::harden() {
  stage_ = "hardening";
  model_.pad_body_load[2] = heaved_share * sleeper_weight();
  for (int level = settling_level() + 1; level <= settings_.ramp_levels; ++level) {
    Softness softness = at_level(level);
    softness.drag = hardening_drag * rattling_frequency(softness.stiffness);
    soften(softness);
    run_steps(settings_.ramp_steps, {});
  }
  model_.pad_body_load.setZero();
}

void Builder::consolidate() {
  stage_ = "consolidating";
  const Settings& s = settings_;
  Softness real = at_level(s.ramp_levels);
  real.drag = 0;
  soften(real);
  const double start = seat_height();
  run_steps(s.preload_steps, {});
  for (int cycle = 0; cycle < s.preload_cycles; ++cycle) {
    ramp_load(0, s.preload);
    ramp_load(s.preload, 0);
  }
  report_.sleeper_settlement = start - seat_height();
}

void Builder::release() {
  stage_ = "releasing";
  take_formwork_away();
  model_.contact.friction = physics_.contact.friction;
  load_once();
}

void Builder::load_once() {
  if (settings_.preload_cycles == 0) return;
  ramp_load(0, settings_.preload);
  run_steps(settings_.preload_steps, {});
  loaded_height_ = seat_height();
  ramp_load(settings_.preload, 0);
}

void Builder::ramp_load(double from, double to) {
  const double time = settings_.preload_steps * relaxation_step(model_, contact_points(), step_safety);
  run({time, time}, {}, [&](double elapsed) {
    model_.pad_body_load[2] = -(from + (to - from) * std::min(elapsed / time, 1.0));
    return false;
  });
}

void Builder::come_to_rest() {
  stage_ = "coming to rest";
  const Settings& s = settings_;
  const Rest rest{0.0, share_of_limits * s.unbalanced_limit, share_of_limits * s.kinetic_limit};
  const auto last = state_.step + s.rest_steps;
  do {  // at true masses a stone may leave a place where scaled inertia held it
    run_steps(static_cast<int>(last - state_.step), rest);
    run_with_true_masses(least_true_steps, most_true_steps, rest);
  } while (!at_rest() && state_.step < last);
  report_.stiffness = s.preload_cycles > 0 ? s.preload / (seat_height() - loaded_height_) : 0.0;
}

bool Builder::at_rest() const {
  return report_.unbalanced_force_ratio <= settings_.unbalanced_limit &&
         report_.kinetic_energy <= settings_.kinetic_limit;
}

void Builder::run_steps(int most, const Rest& rest) {
  const double time = most * relaxation_step(model_, contact_points(), step_safety);
  run({0.0, time}, rest);
}

}  // namespace qdem::bed
