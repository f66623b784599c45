#include "qdem_solver/participant/qdem_case.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "proto/error.hpp"
#include "qdem_solver/contact/calibration.hpp"

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
  bool has_stone = false, has_sleeper = false;
  for (const Section& section : qdem.sections("material")) {
    const std::string name = section.choice("name", {"stone", "sleeper"});
    bool& seen = name == "stone" ? has_stone : has_sleeper;
    if (seen) section.fail("name", "the material '" + name + "' is given twice");
    seen = true;
    (name == "stone" ? physics.stone : physics.sleeper) = read_material(section, name);
  }
  if (!has_stone || !has_sleeper) {
    qdem.fail("material", std::string("the material '") + (has_stone ? "sleeper" : "stone") + "' is missing",
              "add a [[qdem.material]] with that name");
  }
  physics.stone.interaction = physics.sleeper.interaction = read_interaction(qdem);
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

void read_contact(const Section& section, BedPhysics& physics) {
  ContactLaw& law = physics.contact;
  law.damping_ratio = read_damping_ratio(section);
  law.normal_stiffness = read_normal_stiffness(section, physics.stone, law.damping_ratio);
  law.tangential_ratio = section.number_or("tangential_ratio", 0.8, Range::between(0.0, 1.0));
  law.friction = section.number("friction", Range::between(0.0, 2.0));
  law.rounding = section.number("rounding_m", Range::positive());
  physics.ground_friction = section.number_or("ground_friction", law.friction, Range::between(0.0, 2.0));
}

RunAlone read_run(const Section& section) {
  RunAlone run;
  run.duration = section.number_or("duration_s", 0.0, Range::not_negative());
  run.output_interval = section.number_or("output_interval_s", 0.0, Range::not_negative());
  run.load = read_load(section.section("load"));
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
  read_materials(section, result.physics);
  read_contact(section.section("contact"), result.physics);
  result.sensors = read_sensors(section);
  result.run = read_run(section.section("run"));
  section.finish();
  return result;
}

}  // namespace qdem
