#include "qdem_solver/bed/builder.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "proto/error.hpp"
#include "qdem_solver/bed/porosity.hpp"
#include "qdem_solver/bed/rigid_fit.hpp"
#include "qdem_solver/bed/sleeper_shape.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

constexpr int sleeper = 0;  // body number
constexpr double step_safety = 0.8;
constexpr int contacts_of_a_node = 4;     // that touch at once, for the step before any does
constexpr double pouring_skin = 3.0;      // candidate lists live longer while stones fall [roundings]
constexpr double layer_pressure = 4e3;    // [Pa], where tamping ends
constexpr double crib_pressure = 1.5e3;   // [Pa]
constexpr double bedding_drag = 30;       // [1/s]
constexpr double hardening_drag = 1.0;    // of the rattling frequency of a mean stone on one contact
constexpr double heaved_share = 0.95;     // of the sleeper's weight; drag would keep a heavy sleeper down
constexpr double calm_kinetic = 1e-3;     // [J], and
constexpr double calm_unbalanced = 3e-3;  // [-], before the bed is made harder
constexpr double tamping_speed = 0.2;     // [m/s]

/// Volume of a template rounded by r: Steiner's formula, V + A r + M r^2 + 4 pi/3 r^3 with M half the sum of edge
/// length times exterior angle.
double rounded_volume(const Template& shape, double scale, double r) {
  double area = 0.0, curvature = 0.0;
  std::vector<Vector3d> normals;
  for (const Triangle& t : shape.triangles) {
    const Vector3d& a = shape.nodes[t.nodes[0]];
    const Vector3d n = (shape.nodes[t.nodes[1]] - a).cross(shape.nodes[t.nodes[2]] - a);
    area += n.norm() / 2;
    normals.push_back(n.normalized());
  }
  for (const Edge& e : shape.edges) {
    const double angle = std::acos(std::clamp(normals[e.triangles[0]].dot(normals[e.triangles[1]]), -1.0, 1.0));
    curvature += (shape.nodes[e.nodes[1]] - shape.nodes[e.nodes[0]]).norm() * angle / 2;
  }
  return shape.volume() * std::pow(scale, 3) + area * scale * scale * r + curvature * scale * r * r +
         4 * M_PI / 3 * std::pow(r, 3);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Builder::Builder(const Settings& settings, const BedPhysics& physics)
    : settings_(settings), physics_(physics), random_(settings.seed, 1) {}

Bed Builder::build() {
  const auto start = std::chrono::steady_clock::now();
  make_stones();
  pour_layer();
  pour_crib();
  restore_shapes();
  settle();
  harden(settling_level() + 1, bedding_level());
  bed_in();
  harden(bedding_level() + 1, settings_.ramp_levels);
  come_to_rest();
  finish();
  report_.build_wall_s = seconds_since(start);
  check_limits();
  return {std::move(model_), std::move(state_), std::move(report_)};
}

double Builder::envelope_volume(int template_id, double size) const {
  const double r = physics_.contact.rounding;
  return rounded_volume(model_.templates[template_id], size - 2 * r, r);
}

void Builder::make_stones() {
  StoneTemplates stones = make_stone_templates(settings_.shapes);
  report_.notes = std::move(stones.notes);
  model_.templates = std::move(stones.templates);
  const Settings& s = settings_;
  const auto volume_of = [this](int template_id, double size) { return envelope_volume(template_id, size); };
  const int n_templates = s.shapes.n_templates;
  const double solid = 1 - s.target_porosity;
  const double layer = s.wall() * s.spacing * s.depth;
  const double crib = (s.wall() * s.spacing - s.half_length() * s.sleeper_width) * s.crib_height;
  layer_ = draw_stones(s.gradation, n_templates, volume_of, solid * layer, random_);
  if (crib > 0) crib_ = draw_stones(s.gradation, n_templates, volume_of, solid * crib, random_);

  const double cell = s.sleeper_height / s.sleeper_cells;
  model_.templates.push_back(box_shape("sleeper", {-s.sleeper_width / 2, 0, -s.sleeper_height},
                                       {s.sleeper_width / 2, s.half_length(), 0}, cell));
  Body body;
  body.kind = BodyKind::sleeper, body.name = "sleeper", body.template_id = n_templates, body.material_id = 1;
  model_.bodies.push_back(body);
  model_.pad_body = sleeper;
  model_.gravity = physics_.gravity;
  make_batches(model_);
  state_ = make_state(model_, {Placement{}});
  spdlog::info("bed: {} stones in the layer, {} in crib and shoulder", layer_.size(), crib_.size());
}

void Builder::add_planes() {
  const double half = settings_.spacing / 2;
  model_.planes.clear();
  model_.planes.push_back({"ground",
                           {0, 0, settings_.ground_level()},
                           Vector3d::UnitZ(),
                           Vector3d::Zero(),
                           physics_.ground_friction,
                           true,
                           true});
  model_.planes.push_back({"symmetry", Vector3d::Zero(), Vector3d::UnitY(), Vector3d::Zero(), 0.0, true, false});
  model_.planes.push_back({"bay_begin", {-half, 0, 0}, Vector3d::UnitX(), Vector3d::Zero(), 0.0, true, true});
  model_.planes.push_back({"bay_end", {half, 0, 0}, -Vector3d::UnitX(), Vector3d::Zero(), 0.0, true, true});
}

void Builder::soften(const Softness& softness, double preload) {
  const double share = softness.young / physics_.stone.young;
  model_.materials = {physics_.stone, physics_.sleeper};
  for (Material& material : model_.materials) {
    material.young *= share;
    material.lame_viscosity *= share;  // keeps the retardation time
    material.shear_viscosity *= share;
  }
  model_.contact = physics_.contact;
  model_.contact.normal_stiffness = softness.stiffness;
  model_.contact.friction = softness.friction;
  if (share < 1) model_.contact.skin = pouring_skin * physics_.contact.rounding;
  model_.contact.damping_ratio = std::max(softness.damping_ratio, physics_.contact.damping_ratio);
  model_.local_damping = softness.local_damping;
  model_.drag_per_s = softness.drag;
  // Dead load as extra weight of the sleeper, spread as its mass is.
  const double weight = sleeper_weight();
  if (weight > 0) model_.materials[1].density *= 1 + preload / weight;
}

void Builder::add_stones(const std::vector<Stone>& stones, const std::vector<Rectangle>& floor, double bottom) {
  std::vector<double> scales;
  for (const Stone& stone : stones) {
    scales.push_back((1 + settings_.pour_swelling) * (stone.size - 2 * physics_.contact.rounding));
  }
  const auto places =
      stack_loosely(model_.templates, stones, scales, floor, bottom, 1.5 * physics_.contact.rounding, random_);
  const Model before = model_;
  for (std::size_t i = 0; i < stones.size(); ++i) {
    Body body;
    body.name = "stone_" + std::to_string(model_.bodies.size());
    body.template_id = stones[i].template_id;
    body.scale = scales[i];
    model_.bodies.push_back(body);
  }
  make_batches(model_);
  std::vector<Placement> all(model_.bodies.size());
  std::copy(places.begin(), places.end(), all.begin() + static_cast<std::ptrdiff_t>(before.bodies.size()));
  State state = make_state(model_, all);
  state.time = state_.time, state.step = state_.step;
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    const bool old = b < static_cast<int>(before.bodies.size());
    for (int i = 0; i < model_.shape(b).n_nodes(); ++i) {
      if (old) State::scatter(model_, state.x, b, i, state_.position(before, b, i));
      const Vector3d v = old ? state_.velocity(before, b, i) : Vector3d(0, 0, -settings_.pour_speed);
      State::scatter(model_, state.v, b, i, v);
    }
  }
  state_ = std::move(state);
}

void Builder::hold_sleeper(unsigned mask) {
  model_.fixities.clear();
  const Template& shape = model_.shape(sleeper);
  for (int i = 0; i < shape.n_nodes(); ++i) {
    const bool on_cut = shape.nodes[i][1] < 1e-9;
    const unsigned all = mask | (on_cut ? 2u : 0u);
    if (all != 0) model_.fixities.push_back({sleeper, i, all});
  }
}

void Builder::drop_contacts() {
  state_.contact = ContactState{};
}

double Builder::top_of_stones() const {
  double top = settings_.ground_level();
  for (int b = 1; b < static_cast<int>(model_.bodies.size()); ++b) {
    for (const int node : model_.shape(b).surface_nodes) top = std::max(top, state_.position(model_, b, node)[2]);
  }
  return top;
}

double Builder::mass_of_stones() const {
  double mass = 0.0;
  for (int b = 1; b < static_cast<int>(model_.bodies.size()); ++b) mass += model_.body_mass(b);
  return mass;
}

void Builder::run(double least_time, double most_time, const Rest& rest, const std::function<bool()>& enough) {
  const auto clock = std::chrono::steady_clock::now();
  const auto first_step = state_.step;
  Engine engine(model_);
  engine.prepare(state_);
  const StabilityReport bound = stability(model_, state_, engine.contacts());
  double lightest = 1e300;
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    for (const int node : model_.shape(b).surface_nodes) lightest = std::min(lightest, model_.node_mass(b, node));
  }
  const double contact =
      std::max(bound.contacts.stiffness, 2 * contacts_of_a_node * model_.contact.normal_stiffness / lightest);
  const double dashpots = std::max(bound.contacts.damping, 4 * model_.contact.damping_ratio * std::sqrt(contact));
  const double dt =
      step_safety * largest_stable_step({bound.elements.stiffness + contact, bound.elements.damping + dashpots});
  constexpr int block = 200;
  const double mass = mass_of_stones();
  const double start = state_.time;
  while (state_.time - start < most_time) {
    engine.advance(state_, dt, block);
    if (state_.time - start < least_time) continue;
    if (enough && enough()) break;
    const double kinetic = engine.energies(state_).kinetic;
    const bool slow = rest.speed > 0 && std::sqrt(2 * kinetic / mass) < rest.speed;
    const bool still = rest.kinetic > 0 && kinetic < rest.kinetic && engine.unbalanced_ratio(state_) < rest.unbalanced;
    if (slow || still) break;
  }
  report_.kinetic_energy = engine.energies(state_).kinetic;
  report_.unbalanced_force_ratio = engine.unbalanced_ratio(state_);
  const ContactReport contacts = engine.contacts().report(state_);
  report_.coordination_number = contacts.coordination_number;
  report_.largest_penetration = contacts.largest_penetration;
  spdlog::info(
      "bed: {:.3f} s in {} steps of {:.2f} us ({:.1f} s of work), kinetic energy {:.2e} J, unbalanced {:.1e}, "
      "penetration {:.3f} mm, "
      "{} contacts of {} candidates, coordination {:.2f}, top {:.3f} m",
      state_.time - start, state_.step - first_step, 1e6 * dt, seconds_since(clock), report_.kinetic_energy,
      report_.unbalanced_force_ratio, 1e3 * report_.largest_penetration, contacts.live, contacts.candidates,
      contacts.coordination_number, top_of_stones());
}

double Builder::tamp(double level, double pressure) {
  const double r = physics_.contact.rounding;
  const double start = std::max(top_of_stones(), level) + r;
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
  run(0, (start - level) / tamping_speed, {}, [&] { return pressure_on(place(), area) > pressure; });
  const double reached = std::max(place(), level);
  model_.planes.back().velocity.setZero();
  model_.planes.back().point[2] = reached;
  drop_contacts();
  run(0.02, 0.1, {0.02}, {});
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

void Builder::pour_layer() {
  const Settings& s = settings_;
  const double half = s.spacing / 2, gap = 2 * physics_.contact.rounding;
  add_planes();
  model_.planes.push_back({"wall", {0, s.wall(), 0}, -Vector3d::UnitY(), Vector3d::Zero(), 0.0, true, false});
  soften({s.pour_young, s.pour_stiffness, s.pour_friction, 0.3, 0.0, physics_.gravity.norm() / s.pour_speed}, 0);
  // The sleeper waits above the pouring.
  hold_sleeper(7u);
  const double above = 2.0 + 6 * s.depth;
  for (int i = 0; i < model_.shape(sleeper).n_nodes(); ++i) {
    State::scatter(model_, state_.x, sleeper, i, model_.shape(sleeper).nodes[i] + Vector3d(0, 0, above));
  }
  add_stones(layer_, {{-half + gap, half - gap, gap, s.wall() - gap}}, s.ground_level() + gap);
  const double fall = (top_of_stones() - s.ground_level()) / s.pour_speed;
  run(0.4 * fall, 2 * fall, {0.06}, {});
  sleeper_bottom_ = tamp(-s.sleeper_height, layer_pressure);
}

void Builder::pour_crib() {
  const Settings& s = settings_;
  const double half = s.spacing / 2, gap = 2 * physics_.contact.rounding;
  for (int i = 0; i < model_.shape(sleeper).n_nodes(); ++i) {
    const Vector3d lifted(0, 0, sleeper_bottom_ + s.sleeper_height + physics_.contact.rounding);
    State::scatter(model_, state_.x, sleeper, i, model_.shape(sleeper).nodes[i] + lifted);
    State::scatter(model_, state_.v, sleeper, i, Vector3d::Zero());
  }
  if (crib_.empty()) return;
  const double side = s.sleeper_width / 2 + gap, end = s.half_length() + gap;
  const std::vector<Rectangle> floor = {
      {-half + gap, -side, gap, end}, {side, half - gap, gap, end}, {-half + gap, half - gap, end, s.wall() - gap}};
  add_stones(crib_, floor, top_of_stones() + gap);
  drop_contacts();
  const double fall = (top_of_stones() + s.sleeper_height) / s.pour_speed;
  run(0.4 * fall, 2 * fall, {0.06}, {});
  tamp(sleeper_bottom_ + s.crib_height, crib_pressure);
}

Builder::Softness Builder::at_level(int level, double drag) const {
  const Settings& s = settings_;
  const double share = static_cast<double>(level) / s.ramp_levels;
  const double stiffness = s.pour_stiffness * std::pow(physics_.contact.normal_stiffness / s.pour_stiffness, share);
  return {s.pour_young * std::pow(physics_.stone.young / s.pour_young, share),
          stiffness,
          physics_.contact.friction,
          0.3,
          0.5,
          drag * rattling_frequency(stiffness)};
}

void Builder::harden(int first, int last) {
  for (int level = first; level <= last; ++level) {
    soften(at_level(level, hardening_drag), -heaved_share * sleeper_weight());
    run_steps(settings_.ramp_steps, settings_.ramp_steps, {});
  }
}

void Builder::restore_shapes() {
  std::vector<Placement> placements;
  std::vector<Body> bodies = model_.bodies;
  for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
    if (bodies[b].kind == BodyKind::stone) bodies[b].scale /= 1 + settings_.pour_swelling;
    placements.push_back(rigid_fit(model_, state_, b, bodies[b].scale));
  }
  model_.bodies = std::move(bodies);
  make_batches(model_);
  State state = make_state(model_, placements);
  state.time = state_.time, state.step = state_.step;
  state_ = std::move(state);
}

void Builder::settle() {
  add_planes();  // formwork away
  hold_sleeper(1u);
  drop_contacts();
  Softness soft = at_level(settling_level(), 0.0);
  soft.drag = bedding_drag;
  soften(soft, 0);
  run(0.05, 0.25, {0.0, calm_unbalanced, calm_kinetic}, {});
}

void Builder::bed_in() {
  const double start = seat_height();
  Softness soft = at_level(bedding_level(), 0.0);
  soft.drag = bedding_drag;
  soften(soft, settings_.preload);
  run(0.03, 0.1, {0.005}, {});
  soften(soft, 0);
  run(0.03, 0.1, {0.0, calm_unbalanced, calm_kinetic}, {});
  report_.sleeper_settlement = start - seat_height();
}

void Builder::come_to_rest() {
  soften(at_level(settings_.ramp_levels, 0.0), 0);
  model_.drag_per_s = bedding_drag;
  Rest rest;
  rest.kinetic = 0.8 * settings_.kinetic_limit, rest.unbalanced = 0.8 * settings_.unbalanced_limit;
  run_steps(1000, settings_.rest_steps, rest);
  hold_sleeper(0u);  // along the track and upright the rail holds it from now on
}

void Builder::run_steps(int least, int most, const Rest& rest) {
  Engine engine(model_);
  engine.prepare(state_);
  const double dt = step_safety * stability(model_, state_, engine.contacts()).largest_step;
  run(least * dt, most * dt, rest, {});
}

double Builder::sleeper_weight() const {
  return physics_.sleeper.density * model_.shape(sleeper).volume() * physics_.gravity.norm();
}

double Builder::rattling_frequency(double stiffness) const {
  const double mean_mass = mass_of_stones() / static_cast<double>(model_.bodies.size() - 1);
  return std::sqrt(stiffness / mean_mass);
}

double Builder::seat_height() const {
  double height = 0.0;
  int n = 0;
  for (int i = 0; i < model_.shape(sleeper).n_nodes(); ++i) {
    if (model_.shape(sleeper).nodes[i][2] < -1e-9) continue;
    height += state_.position(model_, sleeper, i)[2];
    ++n;
  }
  return height / n;
}

}  // namespace qdem::bed
