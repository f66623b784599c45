#include "qdem_solver/participant/qdem_case.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "proto/error.hpp"
#include "qdem_solver/contact/calibration.hpp"
#include "qdem_solver/participant/layers_case.hpp"

namespace qdem {
namespace {

using proto::Range;
using proto::Section;

/// Ways to give one thing, each a set of keys that belong together.
using Ways = std::vector<std::vector<std::string>>;

std::string listed(const Ways& ways) {
  std::string text;
  for (const auto& keys : ways) {
    if (!text.empty()) text += ", or ";
    for (const std::string& key : keys) text += (&key == &keys.front() ? "" : " with ") + key;
  }
  return text;
}

/// The way that the section takes, if it takes one; two are refused.
std::optional<std::size_t> taken(const Section& section, const std::string& what, const Ways& ways) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const bool any = std::any_of(ways[i].begin(), ways[i].end(), [&](const auto& key) { return section.has(key); });
    if (!any) continue;
    if (found) section.fail(ways[i].front(), what + " is given twice", "give " + listed(ways));
    found = i;
  }
  return found;
}

std::size_t required(const Section& section, const std::string& what, const Ways& ways) {
  const auto found = taken(section, what, ways);
  if (!found) section.fail(ways.front().front(), what + " is missing", "give " + listed(ways));
  return *found;
}

/// tau [s]; 0 where the case gives viscosities, or none. Voigt damping of a harmonic strain at f has the loss factor
/// 2 pi f tau.
double read_retardation_time(const Section& section) {
  const auto way = taken(section, "viscosity",
                         {{"lame_viscosity_pa_s", "shear_viscosity_pa_s"},
                          {"loss_factor", "loss_factor_frequency_hz"},
                          {"retardation_time_s"}});
  if (way != 1) return section.number_or("retardation_time_s", 0.0, Range::not_negative());
  const double loss_factor = section.number("loss_factor", Range::between(0.0, 1.0));
  return loss_factor / (2 * M_PI * section.number("loss_factor_frequency_hz", Range::positive()));
}

Material read_material(const Section& section, const std::string& name) {
  Material material;
  material.name = name;
  material.young = section.number("young_pa", Range::positive());
  material.poisson = section.number("poisson", Range::between(0.0, 0.49));
  material.density = section.number("density_kg_per_m3", Range::positive());
  const double time = read_retardation_time(section);
  material.lame_viscosity = section.number_or("lame_viscosity_pa_s", time * material.lambda(), Range::not_negative());
  material.shear_viscosity = section.number_or("shear_viscosity_pa_s", time * material.mu(), Range::not_negative());
  return material;
}

Interaction read_interaction(const Section& qdem) {
  const std::string name = qdem.choice_or("particle_interaction", "quadruple", {"quadruple", "bond"});
  return name == "bond" ? Interaction::bond : Interaction::quadruple;
}

EngineKind read_engine(const Section& qdem) {
  const std::string name = qdem.choice_or("engine", "cpu", {"cpu", "cuda", "check"});
  for (const EngineKind kind : {EngineKind::cuda, EngineKind::check}) {
    if (name == engine_name(kind)) return kind;
  }
  return EngineKind::cpu;
}

void read_materials(const Section& qdem, BedPhysics& physics) {
  std::vector<std::string> names;
  for (const Section& section : qdem.sections("material")) {
    const std::string name = section.text("name");
    if (std::count(names.begin(), names.end(), name) > 0) {
      section.fail("name", "the material '" + name + "' is given twice");
    }
    names.push_back(name);
    Material material = read_material(section, name);
    material.interaction = read_interaction(qdem);
    if (name == "stone") {
      physics.stone = material;
    } else if (name == "sleeper") {
      physics.sleeper = material;
    } else {
      physics.others.push_back(material);
    }
  }
  for (const std::string needed : {"stone", "sleeper"}) {
    if (std::count(names.begin(), names.end(), needed) > 0) continue;
    const std::string nearest = proto::nearest_name(needed, names);
    qdem.fail("material",
              "the material '" + needed + "' is missing" + (nearest.empty() ? "" : ", found '" + nearest + "'"),
              nearest.empty() ? "add a [[qdem.material]] with that name" : "did you mean '" + needed + "'?");
  }
}

/// A material that nothing is made of is a slip of the pen.
void check_use(const proto::CaseFile& file, const BedPhysics& physics) {
  auto used = file.section("bed").texts_or("stone_materials", {"stone"});
  used.push_back(subgrade_material(file.section("qdem")));
  for (const Material& material : physics.others) {
    if (std::count(used.begin(), used.end(), material.name) > 0) continue;
    const std::string nearest = proto::nearest_name(material.name, std::vector<std::string>{"stone", "sleeper"});
    file.section("qdem").fail("material", "nothing is made of the material '" + material.name + "'",
                              nearest.empty() ? "name it in [bed] stone_materials or [qdem.subgrade], or remove it"
                                              : "did you mean '" + nearest + "'?");
  }
}

double read_damping_ratio(const Section& section) {
  if (required(section, "the contact's damping", {{"damping_ratio"}, {"restitution"}}) == 0) {
    return section.number("damping_ratio", Range::between(0.0, 1.0));
  }
  return damping_ratio_for(section.number("restitution", Range::between(least_restitution(), 1.0)));
}

double read_normal_stiffness(const Section& section, const Material& stone, double damping_ratio) {
  const auto positive = [&](const char* key) { return section.number(key, Range::positive()); };
  switch (required(
      section, "the contact's stiffness",
      {{"normal_stiffness_n_per_m"}, {"hertz_load_n", "hertz_radius_m"}, {"contact_time_s", "contact_mass_kg"}})) {
    case 0:
      return positive("normal_stiffness_n_per_m");
    case 1:
      return hertz_tangent(stone.young, stone.poisson, positive("hertz_radius_m"), positive("hertz_load_n"));
    default:
      return stiffness_for(positive("contact_time_s"), positive("contact_mass_kg") / 2, damping_ratio);
  }
}

void read_contact_shape(const Section& section, ContactLaw& law) {
  if (section.choice_or("law", "facet", {"facet", "sphere"}) == "sphere") law.shape = ContactShape::sphere;
  for (const char* key : {"sphere_radii", "rolling_friction"}) {
    if (law.shape != ContactShape::sphere && section.has(key)) {
      section.fail(key, "it is for contact spheres, and the law is \"facet\"", "set law = \"sphere\", or remove it");
    }
  }
  if (section.choice_or("sphere_radii", "equal", {"equal", "by_edge"}) == "by_edge") law.radii = SphereRadii::by_edge;
  law.rolling_friction = section.number_or("rolling_friction", 0.0, Range::between(0.0, 2.0));
}

void read_contact(const Section& section, BedPhysics& physics) {
  ContactLaw& law = physics.contact;
  read_contact_shape(section, law);
  law.damping_ratio = read_damping_ratio(section);
  law.normal_stiffness = read_normal_stiffness(section, physics.stone, law.damping_ratio);
  law.tangential_ratio = section.number_or("tangential_ratio", 0.8, Range::between(0.0, 1.0));
  law.friction = section.number("friction", Range::between(0.0, 2.0));
  law.rounding = section.number("rounding_m", Range::positive());
  physics.ground_friction = section.number_or("ground_friction", law.friction, Range::between(0.0, 2.0));
}

RunAlone read_run(const Section& section, double gravity) {
  RunAlone run;
  run.duration = section.number_or("duration_s", 0.0, Range::not_negative());
  run.output_interval = section.number_or("output_interval_s", 0.0, Range::not_negative());
  run.loads = read_loads(section, gravity);
  return run;
}

}  // namespace

QdemCase read_qdem_case(const proto::CaseFile& file) {
  const Section section = file.section("qdem");
  QdemCase result;
  result.step_safety = section.number_or("step_safety", result.step_safety, {0.0, 1.0, true});
  result.largest_step = section.number_or("largest_step_s", 0.0, Range::not_negative());
  result.engine = read_engine(section);
  result.threads = static_cast<int>(section.integer_or("threads", 0, Range::between(0, 1024)));
  result.physics.gravity = {0, 0, -section.number_or("gravity_m_per_s2", 9.81, Range::not_negative())};
  result.initialise_damping =
      section.number_or("initialise_damping", result.initialise_damping, Range::between(0, 0.95));
  result.steps_per_viscous_sample = static_cast<int>(
      section.integer_or("steps_per_viscous_sample", result.steps_per_viscous_sample, Range::between(1, 1000)));
  read_materials(section, result.physics);
  read_layers(section, result.physics);
  check_use(file, result.physics);
  const Section contact = section.section("contact");
  read_contact(contact, result.physics);
  check_subgrade(section, result.physics);
  result.initial_overlap_limit = contact.number_or("initial_overlap_limit", 0.01, Range::positive());
  result.sensors = read_sensors(section);
  result.contact_output = section.boolean_or("contact_output", false);
  result.run = read_run(section.section("run"), result.physics.gravity.norm());
  section.finish();
  return result;
}

}  // namespace qdem
