#include "fem_solver/model/settings.hpp"

#include "fem_solver/model/columns.hpp"
#include "proto/case/case_schema.hpp"
#include "proto/case/track.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

using proto::Range;
constexpr double pi = 3.14159265358979323846;

Eigen::Vector3d triple(const proto::Section& section, const std::string& key, const Eigen::Vector3d& fallback) {
  if (!section.has(key)) return fallback;
  const auto values = section.numbers(key, 3, Range::not_negative());
  return {values[0], values[1], values[2]};
}

SupportSettings read_support(const proto::Section& section, const proto::RailSeat& seat) {
  SupportSettings s;
  s.pad_half_lengths = seat.half_lengths;
  s.pad_cells = seat.cells;
  if (section.has("pad_cells")) {
    const auto cells = section.integers("pad_cells", 2, Range::between(1, 64));
    s.pad_cells = {static_cast<int>(cells[0]), static_cast<int>(cells[1])};
  }
  s.pad_stiffness = triple(section, "pad_stiffness_n_per_m", seat.stiffness);
  s.pad_damping = triple(section, "pad_damping_ns_per_m", seat.damping);
  s.pad_tension_cutoff = section.boolean_or("pad_tension_cutoff", s.pad_tension_cutoff);
  s.pad_clip_preload = section.number_or("pad_clip_preload_n", s.pad_clip_preload, Range::not_negative());
  s.pad_second_stiffness = section.number_or("pad_second_stiffness_n_per_m", 0.0, Range::not_negative());
  s.pad_second_begin = section.number_or("pad_second_begin_m", 0.0, Range::not_negative());
  if (s.pad_second_stiffness != 0.0 && s.pad_second_stiffness < s.pad_stiffness[2])
    section.fail("pad_second_stiffness_n_per_m", "the pad would soften when pressed",
                 "give at least the third value of pad_stiffness_n_per_m");
  s.sleeper_mass = section.number_or("sleeper_mass_kg", s.sleeper_mass, Range::positive());
  s.ballast_stiffness = triple(section, "ballast_stiffness_n_per_m", s.ballast_stiffness);
  s.ballast_damping = triple(section, "ballast_damping_ns_per_m", s.ballast_damping);
  if (s.ballast_stiffness.minCoeff() <= 0)
    section.fail("ballast_stiffness_n_per_m", "a ballast stiffness of zero leaves the sleeper free",
                 "give three positive values");
  return s;
}

Irregularity read_irregularity(const proto::Section& section) {
  Irregularity r;
  const std::string kind = section.choice_or("kind", "none", {"none", "dipped_joint", "corrugation", "table"});
  if (kind == "dipped_joint") {
    r.kind = IrregularityKind::dipped_joint;
    r.depth = section.number("depth_m", Range::not_negative());
    r.length = section.number("length_m", Range::positive());
    r.position = section.number("position_m");
  } else if (kind == "corrugation") {
    r.kind = IrregularityKind::corrugation;
    r.depth = section.number("amplitude_m", Range::not_negative());
    r.length = section.number("wavelength_m", Range::positive());
    r.position = section.number("begin_m");
  } else if (kind == "table") {
    r = read_irregularity_table(section.existing_path("file"));
  }
  return r;
}

Irregularity read_defect(const proto::Section& section, double radius) {
  Irregularity r;
  r.radius = radius;
  const std::string kind = section.choice_or("kind", "none", {"none", "fresh_flat", "rounded_flat", "polygon"});
  if (kind == "fresh_flat" || kind == "rounded_flat") {
    r.kind = kind == "fresh_flat" ? IrregularityKind::fresh_flat : IrregularityKind::rounded_flat;
    r.length = section.number("length_m", {0.0, radius / 2, true});  // a flat, not half a wheel
    if (kind == "rounded_flat") r.depth = section.number("depth_m", Range::not_negative());
    r.position = section.number("position_m");
  } else if (kind == "polygon") {
    // A polygon of the wheel is a corrugation whose waves close after a turn.
    r.kind = IrregularityKind::corrugation;
    r.depth = section.number("amplitude_m", Range::not_negative());
    r.length = 2 * pi * radius / static_cast<double>(section.integer("order", Range::between(1, 500)));
    r.position = section.number("begin_m");
  }
  return r;
}

SuspensionSettings read_suspension(const proto::Section& section, const WheelSettings& wheel) {
  SuspensionSettings s;
  s.stiffness = section.number_or("stiffness_n_per_m", 0.0, Range::not_negative());
  if (s.stiffness == 0.0) return s;
  s.damping = section.number_or("damping_ns_per_m", 0.0, Range::not_negative());
  const double carried = wheel.static_load / gravity - wheel.unsprung_mass;
  if (carried <= 0)
    section.fail("stiffness_n_per_m", "the static load is not more than the weight of the unsprung mass",
                 "raise wheel.static_load_n or leave the suspension out");
  s.sprung_mass = section.number_or("sprung_mass_kg", carried, Range::positive());
  return s;
}

SolidWheelSettings read_solid_wheel(const proto::Section& section) {
  SolidWheelSettings s;
  const std::string tread = section.choice_or("tread", "S1002", {"S1002", "cone_1_20", "cone_1_40"});
  s.tread = tread == "S1002" ? TreadKind::s1002 : tread == "cone_1_20" ? TreadKind::cone_1_20 : TreadKind::cone_1_40;
  s.density = section.number_or("density_kg_per_m3", s.density, Range::positive());
  s.loss_factor = section.number_or("loss_factor", s.loss_factor, Range::between(0.0, 1.0));
  if (!section.has("web_file")) return s;
  const std::string path = section.existing_path("web_file");
  const TwoColumns file(path, "wheel's web", "radius_m, thickness_m");
  file.require_ascending();
  s.web_radius.clear(), s.web_thickness.clear();
  for (const auto& row : file.rows()) {
    if (row.first <= 0 || row.second <= 0)
      throw proto::Error(proto::ExitCode::bad_data, "a radius or thickness of the wheel's web is not positive",
                         path + ":" + std::to_string(row.line));
    s.web_radius.push_back(row.first), s.web_thickness.push_back(row.second);
  }
  return s;
}

}  // namespace

FemSettings read_fem(const proto::CaseFile& file, const std::vector<proto::RailSeat>& seats) {
  const proto::Section section = file.section("fem");
  FemSettings s;
  s.profile_is_file = section.has("profile_file");
  if (s.profile_is_file && section.has("profile"))
    section.fail("profile_file", "the rail has a profile already", "give either profile or profile_file");
  s.profile = s.profile_is_file ? section.existing_path("profile_file")
                                : section.choice_or("profile", s.profile, rail_section_names());
  s.n_bays = static_cast<int>(section.integer_or("n_bays", s.n_bays, Range::between(4, 200)));
  if (s.n_bays % 2)
    section.fail("n_bays", "the number of bays is odd", "give an even number: the rail is symmetric about x = 0");
  s.element_length = section.number_or("element_length_m", s.element_length, Range::positive());
  s.material.young = section.number_or("young_pa", s.material.young, Range::positive());
  s.material.poisson = section.number_or("poisson", s.material.poisson, Range::between(0.0, 0.49));
  s.material.density = section.number_or("density_kg_per_m3", s.material.density, Range::positive());
  s.loss_factor = section.number_or("loss_factor", s.loss_factor, Range::between(0.0, 1.0));
  s.loss_factor_frequency = section.number_or("loss_factor_frequency_hz", s.loss_factor_frequency, Range::positive());
  s.gravity = section.boolean_or("gravity", s.gravity);
  s.end_dashpot_frequency =
      section.number_or("end_dashpot_frequency_hz", s.end_dashpot_frequency, Range::not_negative());
  s.end_layer_bays = static_cast<int>(section.integer_or("end_layer_bays", s.end_layer_bays, Range::between(0, 50)));
  s.end_layer_element_length =
      section.number_or("end_layer_element_length_m", s.end_layer_element_length, Range::positive());
  s.end_layer_damping = section.number_or("end_layer_damping_per_s", s.end_layer_damping, Range::not_negative());
  s.initialise_damping = section.number_or("initialise_damping_per_s", s.initialise_damping, Range::not_negative());
  s.sleeper_spacing = proto::read_track(file).sleeper_spacing;
  s.support = read_support(section.section("support"), seats.front());
  section.finish();
  return s;
}

WheelSettings read_wheel(const proto::CaseFile& file, const Material& rail) {
  const proto::Section section = file.section("wheel");
  WheelSettings w;
  w.speed = section.number("speed_m_per_s", Range::not_negative());
  w.start = section.number("start_m");
  w.static_load = section.number("static_load_n", Range::positive());
  w.unsprung_mass = section.number("unsprung_mass_kg", Range::positive());
  w.radius = section.number("radius_m", Range::positive());
  w.rail_crown_radius = section.number_or("rail_crown_radius_m", w.rail_crown_radius, Range::positive());
  w.rail = {rail.young, rail.poisson};
  w.wheel.young = section.number_or("young_pa", rail.young, Range::positive());
  w.wheel.poisson = section.number_or("poisson", rail.poisson, Range::between(0.0, 0.49));
  w.irregularity = read_irregularity(section.section("irregularity"));
  w.defect = read_defect(section.section("defect"), w.radius);
  w.suspension = read_suspension(section.section("suspension"), w);
  w.kind = section.choice_or("model", "mass", {"mass", "solid"}) == "mass" ? WheelKind::mass : WheelKind::solid;
  w.solid = read_solid_wheel(section.section("solid"));
  if (section.choice_or("contact", "hertz", {"hertz", "patch"}) == "patch")
    w.patch = read_patch(section.section("patch"), w.radius, w.rail_crown_radius);
  w.longest_contact_loss = section.number_or("longest_contact_loss_s", w.longest_contact_loss, Range::positive());
  section.finish();
  return w;
}

std::string fem_schema() {
  return proto::case_schema({[](const proto::CaseFile& file) { read_fem(file, proto::read_rail_seats(file)); },
                             [](const proto::CaseFile& file) { read_wheel(file, {}); }});
}

}  // namespace fem
