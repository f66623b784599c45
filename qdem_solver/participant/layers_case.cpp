#include "qdem_solver/participant/layers_case.hpp"

#include <cmath>
#include <vector>

#include "qdem_solver/contact/entry_laws.hpp"

namespace qdem {
namespace {

using proto::Range;
using proto::Section;

Bearing read_layer(const Section& qdem, const char* name) {
  if (!qdem.has(name)) return {};
  const Section section = qdem.section(name);
  Bearing bearing;
  bearing.footprint = section.number("footprint_m2", Range::positive());
  bearing.normal_stiffness = section.number("bedding_modulus_n_per_m3", Range::positive()) * bearing.footprint;
  const double shear_ratio = section.number_or("shear_ratio", 0.3, {0.0, 1.0, true});
  bearing.tangential_stiffness = shear_ratio * bearing.normal_stiffness;
  if (section.has("loss_factor") || section.has("loss_factor_frequency_hz")) {
    const double omega = 2 * M_PI * section.number("loss_factor_frequency_hz", Range::positive());
    bearing.normal_damping = section.number("loss_factor", Range::between(0.0, 1.0)) * bearing.normal_stiffness / omega;
    bearing.tangential_damping = shear_ratio * bearing.normal_damping;
  }
  return bearing;
}

bool is_half_space(const Section& subgrade) {
  return subgrade.choice_or("kind", "rigid", {"rigid", "half_space"}) == "half_space";
}

Bearing read_subgrade(const Section& section, const std::vector<Material>& materials) {
  if (!is_half_space(section)) return {};
  std::vector<std::string> names;
  for (const Material& material : materials) names.push_back(material.name);
  const std::string name = section.choice("material", names);
  const double radius = section.number("footprint_radius_m", Range::positive());
  for (const Material& material : materials) {
    if (material.name == name) return half_space(material, radius);
  }
  return {};
}

}  // namespace

void read_layers(const Section& qdem, BedPhysics& physics) {
  physics.lining = read_layer(qdem, "under_sleeper_pad");
  const Bearing mat = read_layer(qdem, "under_ballast_mat");
  physics.ground = in_series(mat, read_subgrade(qdem.section("subgrade"), physics.materials()));
}

std::string subgrade_material(const Section& qdem) {
  const Section subgrade = qdem.section("subgrade");
  return is_half_space(subgrade) ? subgrade.text_or("material", "") : "";
}

}  // namespace qdem
