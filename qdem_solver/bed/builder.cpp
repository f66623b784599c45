#include "qdem_solver/bed/builder.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "proto/clock.hpp"
#include "proto/error.hpp"
#include "qdem_solver/bed/drawn_stones.hpp"
#include "qdem_solver/bed/sleeper_shape.hpp"
#include "qdem_solver/state/rigid_fit.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

constexpr int sleeper = 0;                                     // body number
constexpr double poured_speed = 0.06;                          // [m/s], below which a pouring is over
constexpr double layer_pressure = 4e3, crib_pressure = 1.5e3;  // [Pa], where tamping ends

}  // namespace

Builder::Builder(const Settings& settings, const BedPhysics& physics)
    : settings_(settings), physics_(physics), random_(settings.seed, 1), ground_(settings.ground_level()) {}

Bed Builder::build() {
  const auto start = std::chrono::steady_clock::now();
  make_stones();
  pour_layer();
  pour_crib();
  strip();
  settle();
  harden();
  consolidate();
  release();
  come_to_rest();
  finish();
  report_.build_wall_s = proto::seconds_since(start);
  check_limits();
  return {std::move(model_), std::move(state_), std::move(report_)};
}

Bed Builder::lay_on_subgrade(Bed base) {
  const auto start = std::chrono::steady_clock::now();
  stage_ = "settling on the subgrade";
  take_over(std::move(base));
  ground_ = lay_subgrade(model_, state_, *physics_.subgrade);
  make_real();
  run_steps(settings_.preload_steps, {});
  return loaded_and_at_rest(start);
}

Bed Builder::rest_anew(Bed base) {
  const auto start = std::chrono::steady_clock::now();
  stage_ = "loading anew";
  take_over(std::move(base));
  make_real();
  make_batches(model_);  // with the bonds that the other law may need
  return loaded_and_at_rest(start);
}

void Builder::take_over(Bed base) {
  falling_ = false;
  model_ = std::move(base.model), state_ = std::move(base.state), report_ = std::move(base.report);
  report_.from_cache = false;
}

void Builder::make_real() {
  hold_sleeper(held_along_track);
  soften(at_level(settings_.ramp_levels));
  model_.contact.friction = physics_.contact.friction, model_.drag_per_s = 0;
}

Bed Builder::loaded_and_at_rest(std::chrono::steady_clock::time_point start) {
  load_once();
  come_to_rest();
  finish();
  report_.build_wall_s += proto::seconds_since(start);
  check_limits();
  return {std::move(model_), std::move(state_), std::move(report_)};
}

double Builder::envelope_volume(int template_id, double size) const {
  return bed::envelope_volume(model_.templates[template_id], size, physics_.contact.rounding);
}

void Builder::make_stones() {
  const Settings& s = settings_;
  DrawnStones stones = draw_bed(s, physics_.contact.rounding, random_);
  report_.notes = std::move(stones.notes);
  if (!s.shapes.files.empty()) {
    for (const std::string& note : report_.notes) spdlog::info("bed: {}", note);
  }
  model_.templates = std::move(stones.templates);
  layer_ = std::move(stones.layer), crib_ = std::move(stones.crib);

  model_.templates.push_back(sleeper_mesh("sleeper", s.sleeper, s.sleeper_cells));
  Body body;
  body.kind = BodyKind::sleeper, body.name = "sleeper", body.template_id = s.shapes.n_templates, body.material_id = 1;
  model_.bodies.push_back(body);
  model_.pad_body = sleeper;
  model_.materials = physics_.materials();
  model_.gravity = physics_.gravity, model_.lining = physics_.lining;
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
                           true,
                           physics_.ground});
  model_.planes.push_back({"symmetry", Vector3d::Zero(), Vector3d::UnitY(), Vector3d::Zero(), 0.0, true, false});
  model_.planes.push_back({"bay_begin", {-half, 0, 0}, Vector3d::UnitX(), Vector3d::Zero(), 0.0, true, true});
  model_.planes.push_back({"bay_end", {half, 0, 0}, -Vector3d::UnitX(), Vector3d::Zero(), 0.0, true, true});
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
    body.template_id = stones[i].template_id, body.material_id = stones[i].material_id;
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
  auto& held = model_.fixities;
  held.erase(std::remove_if(held.begin(), held.end(), [](const Fixity& f) { return f.body == sleeper; }), held.end());
  const Template& shape = model_.shape(sleeper);
  for (int i = 0; i < shape.n_nodes(); ++i) {
    const bool on_cut = shape.nodes[i][1] < 1e-9;
    const unsigned all = mask | (on_cut ? 2u : 0u);
    if (all != 0) held.push_back({sleeper, i, all});
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
  for (int b = 1; b < static_cast<int>(model_.bodies.size()); ++b) {
    if (model_.bodies[b].kind == BodyKind::stone) mass += model_.body_mass(b);
  }
  return mass;
}

void Builder::pour_layer() {
  stage_ = "pouring the layer";
  const Settings& s = settings_;
  const double half = s.spacing / 2, gap = 2 * physics_.contact.rounding;
  add_planes();
  model_.planes.push_back({"wall", {0, s.wall(), 0}, -Vector3d::UnitY(), Vector3d::Zero(), 0.0, true, false});
  soften({s.pour_young, s.pour_stiffness, s.pour_friction, 0.0, physics_.gravity.norm() / s.pour_speed});
  // The sleeper waits above the pouring.
  hold_sleeper(7u);
  const double above = 2.0 + 6 * s.depth;
  for (int i = 0; i < model_.shape(sleeper).n_nodes(); ++i) {
    State::scatter(model_, state_.x, sleeper, i, model_.shape(sleeper).nodes[i] + Vector3d(0, 0, above));
  }
  add_stones(layer_, {{-half + gap, half - gap, gap, s.wall() - gap}}, s.ground_level() + gap);
  const double fall = (top_of_stones() - s.ground_level()) / s.pour_speed;
  run({0.4 * fall, 2 * fall}, {poured_speed});
  stage_ = "tamping the layer";
  sleeper_bottom_ = tamp(-s.sleeper.height(), layer_pressure);
}

void Builder::pour_crib() {
  const Settings& s = settings_;
  const double half = s.spacing / 2, gap = 2 * physics_.contact.rounding;
  for (int i = 0; i < model_.shape(sleeper).n_nodes(); ++i) {
    const Vector3d lifted(0, 0, sleeper_bottom_ + s.sleeper.height() + physics_.contact.rounding);
    State::scatter(model_, state_.x, sleeper, i, model_.shape(sleeper).nodes[i] + lifted);
    State::scatter(model_, state_.v, sleeper, i, Vector3d::Zero());
  }
  if (crib_.empty()) return;
  stage_ = "pouring crib and shoulder";
  const double side = s.sleeper.width() / 2 + gap, end = s.half_length() + gap;
  const std::vector<Rectangle> floor = {
      {-half + gap, -side, gap, end}, {side, half - gap, gap, end}, {-half + gap, half - gap, end, s.wall() - gap}};
  add_stones(crib_, floor, top_of_stones() + gap);
  drop_contacts();
  const double fall = (top_of_stones() + s.sleeper.height()) / s.pour_speed;
  run({0.4 * fall, 2 * fall}, {poured_speed});
  stage_ = "tamping crib and shoulder";
  tamp(sleeper_bottom_ + s.crib_height, crib_pressure);
}

void Builder::strip() {
  const Settings& s = settings_;
  const double top = sleeper_bottom_ + s.crib_height;
  std::vector<Body> bodies;
  std::vector<Placement> placements;
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    Body body = model_.bodies[b];
    const Vector3d centre = body_centre(b);
    const double shoulder = s.half_length() + s.shoulder_width + s.shoulder_slope * (top - centre[2]);
    if (b != sleeper && (centre[2] > top || centre[1] > shoulder)) continue;
    if (b != sleeper) body.scale /= 1 + s.pour_swelling;
    placements.push_back(rigid_fit(model_, state_, b, body.scale));
    bodies.push_back(body);
  }
  spdlog::info("bed: {} stones beyond the profile taken away", model_.bodies.size() - bodies.size());
  model_.bodies = std::move(bodies);
  make_batches(model_);
  State state = make_state(model_, placements);
  state.time = state_.time, state.step = state_.step;
  state_ = std::move(state);
  add_planes();
  lay_formwork();
}

void Builder::lay_formwork() {
  const Vector3d out = Vector3d(0, 1, settings_.shoulder_slope).normalized();
  double reach = 0.0;
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    if (b == sleeper) continue;
    for (const int node : model_.shape(b).surface_nodes)
      reach = std::max(reach, out.dot(state_.position(model_, b, node)));
  }
  reach += physics_.contact.rounding;
  model_.planes.push_back({"formwork", reach * out, -out, Vector3d::Zero(), 0.0, true, false});
}

void Builder::take_formwork_away() {
  model_.planes.pop_back();
  state_.contact.list_id = 0;  // the next list is without it, and keeps the other contacts' slip
}

Eigen::Vector3d Builder::body_centre(int body) const {
  const Template& shape = model_.shape(body);
  Vector3d centre = Vector3d::Zero();
  for (int i = 0; i < shape.n_nodes(); ++i) {
    centre += shape.node_volumes[i] / shape.volume() * state_.position(model_, body, i);
  }
  return centre;
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
