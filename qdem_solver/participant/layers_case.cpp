#include "qdem_solver/participant/layers_case.hpp"

#include <algorithm>
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

std::string kind_of(const Section& subgrade) {
  return subgrade.choice_or("kind", "rigid", {"rigid", "half_space", "layer"});
}

const Material& read_material(const Section& subgrade, const std::vector<Material>& materials) {
  std::vector<std::string> names;
  for (const Material& material : materials) names.push_back(material.name);
  const std::string name = subgrade.choice("material", names);
  return *std::find_if(materials.begin(), materials.end(), [&](const Material& m) { return m.name == name; });
}

SubgradeLayer read_elements(const Section& section, const Material& material) {
  SubgradeLayer layer;
  layer.material = material;
  layer.material.interaction = Interaction::quadruple;
  layer.thickness = section.number("thickness_m", Range::positive());
  layer.width = section.number("width_m", Range::positive());
  layer.element = section.number("element_m", Range::positive());
  if (layer.element > layer.thickness) {
    section.fail("element_m", "the elements are larger than the layer is thick", "lower it, or raise thickness_m");
  }
  const auto alpha = section.numbers_or("boundary_stiffness", {1.0, 0.5}, Range::not_negative());
  if (alpha.size() != 2) section.fail("boundary_stiffness", "two numbers are needed, normal and tangential");
  if (!(alpha[0] > 0)) {
    section.fail("boundary_stiffness", "without springs the ground sinks under the weight of the bed",
                 "give a positive first number; 1.0 is usual");
  }
  layer.normal_stiffness = alpha[0], layer.tangential_stiffness = alpha[1];
  layer.highest_frequency = section.number_or("highest_frequency_hz", 0.0, Range::not_negative());
  return layer;
}

}  // namespace

void read_layers(const Section& qdem, BedPhysics& physics) {
  physics.lining = read_layer(qdem, "under_sleeper_pad");
  physics.ground = read_layer(qdem, "under_ballast_mat");
  const Section subgrade = qdem.section("subgrade");
  const std::string kind = kind_of(subgrade);
  if (kind == "rigid") return;
  const std::vector<Material> materials = physics.materials();
  const Material& material = read_material(subgrade, materials);
  if (kind == "half_space") {
    const double radius = subgrade.number("footprint_radius_m", Range::positive());
    physics.ground = in_series(physics.ground, half_space(material, radius));
  } else {
    physics.subgrade = read_elements(subgrade, material);
  }
}

void check_subgrade(const Section& qdem, const BedPhysics& physics) {
  if (!physics.subgrade) return;
  const Section subgrade = qdem.section("subgrade");
  if (physics.contact.shape == ContactShape::sphere) {
    subgrade.fail("kind", "contact spheres fall between the particles of a layer of elements",
                  "set [qdem.contact] law = \"facet\", or another kind");
  }
  if (!physics.ground.is_rigid()) {
    subgrade.fail("kind", "a layer of elements cannot carry [qdem.under_ballast_mat]", "remove one of the two");
  }
}

std::string subgrade_material(const Section& qdem) {
  const Section subgrade = qdem.section("subgrade");
  return kind_of(subgrade) == "rigid" ? "" : subgrade.text_or("material", "");
}

}  // namespace qdem
