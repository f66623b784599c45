#include "qdem_solver/participant/track_bed.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"
#include "proto/result/provenance.hpp"
#include "qdem_solver/contact/calibration.hpp"
#include "qdem_solver/contact/initial_overlap.hpp"
#include "qdem_solver/contact/sphere_radii.hpp"
#include "qdem_solver/model/pad_cells.hpp"

namespace qdem {
namespace {

constexpr double reserve = 2;               // speeds may grow while the step found holds
constexpr double share_of_rounding = 0.01;  // so near is as good as touching, for bodies that hardly move

Bed bed_of(const proto::CaseFile& file, const QdemCase& settings, const BedSource& source) {
  if (settings.threads > 0) omp_set_num_threads(settings.threads);
  return source(file, settings.physics);
}

/// What a case says about its model before there is a bed.
Model without_bodies(const QdemCase& settings) {
  Model model;
  model.contact = settings.physics.contact;
  model.lining = settings.physics.lining;
  Plane ground;
  ground.bearing = settings.physics.ground;
  model.planes.push_back(ground);
  if (settings.physics.subgrade) {
    Body layer;
    layer.kind = BodyKind::ground;
    model.bodies.push_back(layer);
  }
  for (const LoadSettings& load : settings.run.loads) {
    if (acts_on_patch(load)) model.loads.push_back(load.load);
  }
  return model;
}

}  // namespace

TrackBed::TrackBed(const proto::CaseFile& file, const BedSource& source, std::function<void()> on_step, BedRole role)
    : settings_(read_qdem_case(file)),
      seats_(proto::read_rail_seats(file)),
      bed_(bed_of(file, settings_, source)),
      rest_(bed_.state) {
  refuse_initial_overlaps(bed_.model, rest_, settings_.initial_overlap_limit, file.name() + ", bed " + bed_.report.hash,
                          "place the bodies apart; where weights alone press soft contacts so deep, raise "
                          "[qdem.contact] initial_overlap_limit");
  bed_.model.pads = make_pad_cells(bed_.model, bed_.state, bed_.model.pad_body, seats_);
  if (role == BedRole::alone) bed_.model.loads = make_patch_loads(bed_.model, bed_.state, settings_.run.loads);
  engine_ = std::make_unique<Engine>(bed_.model, EngineOptions{settings_.threads, std::move(on_step),
                                                               settings_.steps_per_viscous_sample, settings_.engine});
  engine_->set_pad_reference(rest_.x);
  engine_->prepare(bed_.state);
  relaxation_.emplace(bed_.model, resting_points, settings_.step_safety);
  bound_.emplace(bed_.model);
  find_step(0.0);
  check_step(file);
}

void TrackBed::find_step(double duration) {
  const double moved = reserve * 2 * engine_->largest_speed(bed_.state) * duration;
  step_bound_ = bound_->at(bed_.state, engine_->contacts(), touching_gap() + moved);
  largest_step_ = settings_.step_safety * step_bound_;
  if (settings_.largest_step > 0) largest_step_ = std::min(largest_step_, settings_.largest_step);
}

double TrackBed::touching_gap() const {
  return share_of_rounding * bed_.model.contact.rounding;
}

void TrackBed::check_step(const proto::CaseFile& file) const {
  if (!(settings_.largest_step > step_bound_)) return;
  file.section("qdem").fail(
      "largest_step_s",
      fmt::format("{:.4g} s is above the stability bound of {:.4g} s", settings_.largest_step, step_bound_),
      "lower it, or leave it out: the step then follows from the bound and step_safety");
}

void TrackBed::relax() {
  bed_.model.local_damping = settings_.initialise_damping;
  relaxation_->begin(*engine_, bed_.state);
}

void TrackBed::release(double duration, const std::vector<double>& rail_foot) {
  bed_.model.inertia.assign(bed_.model.bodies.size(), Inertia{});
  find_step(duration);
  const auto n_steps = static_cast<std::int64_t>(std::ceil(duration / largest_step_));
  engine_->advance(bed_.state, largest_step_, n_steps, {rail_foot, rail_foot});
  bed_.model.inertia.clear();
  bed_.model.local_damping = 0;
}

void TrackBed::begin_march() {
  bed_.state.step = 0, bed_.state.time = 0.0;
  bed_.state.contact.rebuild_time = 0.0;
  engine_->open_ledger(bed_.state);
}

std::vector<proto::Fact> TrackBed::facts() const {
  const BedReport& report = bed_.report;
  std::vector<proto::Fact> facts;
  const auto add = [&](const char* key, double value) { facts.push_back({key, value, {}}); };
  add("bed.stones", static_cast<double>(report.stones));
  add("bed.elements", static_cast<double>(report.elements));
  add("bed.seed", static_cast<double>(report.seed));
  add("bed.porosity", report.porosity_layer);
  add("bed.porosity_under_sleeper", report.porosity_under_sleeper);
  add("bed.stiffness_n_per_m", report.stiffness);
  add("bed.coordination_number", report.coordination_number);
  add("bed.largest_penetration_m", report.largest_penetration);
  add("bed.unbalanced_force_ratio", report.unbalanced_force_ratio);
  add("bed.kinetic_energy_j", report.kinetic_energy);
  add("bed.d50_m", report.d50);
  add("bed.elements_per_stone", report.elements_per_stone);
  add("bed.sleeper_tilt_rad", report.sleeper_tilt);
  add("bed.build_wall_s", report.build_wall_s);
  facts.push_back({"bed.hash", std::nullopt, report.hash});
  facts.push_back({"bed.source", std::nullopt, report.from_cache ? "cache" : "built"});
  add("qdem.normal_stiffness_n_per_m", bed_.model.contact.normal_stiffness);
  add("qdem.damping_ratio", bed_.model.contact.damping_ratio);
  add("qdem.restitution", restitution_of(bed_.model.contact.damping_ratio));
  if (bed_.model.contact.shape == ContactShape::sphere) add("qdem.open_facets", open_facets(bed_.model));
  add("qdem.step_bound_s", step_bound_);
  add("qdem.largest_step_s", largest_step_);
  add("qdem.damping_step_factor", bound_->viscosity_factor(bed_.state, engine_->contacts(), touching_gap()));
  add("qdem.seat_mass_kg", bed_.model.body_mass(bed_.model.pad_body) / static_cast<double>(seats_.size()));
  facts.push_back({"qdem.engine", std::nullopt, engine_name(settings_.engine)});
  add("qdem.threads", settings_.threads > 0 ? settings_.threads : omp_get_max_threads());
  add_layers(facts);
  return facts;
}

void TrackBed::add_layers(std::vector<proto::Fact>& facts) const {
  const Model& model = bed_.model;
  const BedPhysics& physics = settings_.physics;
  const auto add = [&](const char* key, double value) { facts.push_back({key, value, {}}); };
  if (physics.subgrade) {
    add("qdem.subgrade_elements", static_cast<double>(model.templates.back().n_tets()));
    add("qdem.subgrade_frequency_hz", physics.subgrade->resolved_frequency());
  }
  if (physics.lining.is_rigid() && physics.ground.is_rigid()) return;
  const ContactReport contacts = engine_->contacts().report(bed_.state);
  if (!physics.lining.is_rigid()) {
    add("qdem.pad_contacts", static_cast<double>(contacts.on_lining));
    add("qdem.pad_pressed_area_m2", static_cast<double>(contacts.on_lining) * physics.lining.footprint);
  }
  if (!physics.ground.is_rigid()) {
    add("qdem.ground_contacts", static_cast<double>(contacts.on_bearing));
    add("qdem.ground_pressed_area_m2", static_cast<double>(contacts.on_bearing) * physics.ground.footprint);
  }
  Model rigid = model;
  rigid.lining = {};
  for (Plane& plane : rigid.planes) plane.bearing = {};
  add("qdem.layers_step_factor", step_bound_ / bound_->at(bed_.state, ContactStage(rigid), touching_gap()));
}

proto::Attributes TrackBed::attributes(const proto::CaseFile& file) const {
  auto attributes = proto::provenance("qdem_solver", file.name(), file.hash(), file.text());
  attributes.emplace_back("bed_hash", bed_.report.hash);
  attributes.emplace_back("bed_seed", bed_.report.seed);
  return attributes;
}

void check_case(const proto::CaseFile& file) {
  const QdemCase settings = read_qdem_case(file);
  const std::string unknown = unknown_to_engine(settings.engine, without_bodies(settings));
  if (!unknown.empty()) {
    file.section("qdem").fail("engine", "the device engine does not know " + unknown,
                              "give \"cpu\", or leave that out of the case");
  }
  const std::string missing = why_no_engine(settings.engine);
  if (!missing.empty()) {
    file.section("qdem").fail("engine", "the CUDA engine cannot be used: " + missing,
                              "give \"cpu\", or build with the preset cuda and run where a CUDA device is");
  }
  proto::read_rail_seats(file);
}

}  // namespace qdem
