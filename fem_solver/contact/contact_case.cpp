#include "fem_solver/contact/contact_case.hpp"

namespace fem {
namespace {

using proto::Range;

PatchGrid read_grid(const proto::Section& section, const std::optional<PatchEllipse>& hertz) {
  if (section.has("elements") || section.has("element_m")) {
    const auto count = section.integers("elements", 2, Range::between(1, 400));
    const auto side = section.numbers("element_m", 2, Range::positive());
    return {static_cast<int>(count[0]), static_cast<int>(count[1]), side[0], side[1]};
  }
  const int elements = static_cast<int>(section.integer_or("elements_per_semi_axis", 10, Range::between(4, 60)));
  const double margin = section.number_or("margin", 1.25, Range::between(1.0, 4.0));
  if (!hertz)
    section.fail("elements", "without two radii no ellipse gives the size of the grid",
                 "give elements = [n_x, n_y] and element_m = [dx, dy]");
  return grid_around(*hertz, elements, margin);
}

}  // namespace

ContactGeometry read_geometry(const proto::Section& section, double wheel_radius, double crown_radius) {
  ContactGeometry geometry{1 / wheel_radius, crown_radius > 0 ? 1 / crown_radius : 0.0, {}, 0.0};
  if (!section.has("wheel_profile") && !section.has("rail_profile")) return geometry;
  for (const char* key : {"wheel_profile", "rail_profile"}) section.text(key);  // both are there, whatever they name
  geometry.profiles = {SurfaceProfile(section.existing_path("wheel_profile")),
                       SurfaceProfile(section.existing_path("rail_profile"))};
  geometry.wheel_shift = section.number_or("wheel_shift_m", 0.0);
  return geometry;
}

double read_friction(const proto::Section& section) {
  return section.number("friction", Range::between(0.0, 1.0));
}

Creepage read_creepage(const proto::Section& section) {
  return {section.number_or("longitudinal_creepage", 0.0, Range::between(-1.0, 1.0)),
          section.number_or("lateral_creepage", 0.0, Range::between(-1.0, 1.0)), section.number_or("spin_per_m", 0.0)};
}

ContactCase read_contact(const proto::CaseFile& file) {
  const proto::Section section = file.section("contact");
  ContactCase c;
  c.normal_force = section.number("normal_force_n", Range::positive());
  c.friction = read_friction(section);
  c.rail.young = section.number_or("young_pa", c.rail.young, Range::positive());
  c.rail.poisson = section.number_or("poisson", c.rail.poisson, Range::between(0.0, 0.5));
  c.wheel.young = section.number_or("wheel_young_pa", c.rail.young, Range::positive());
  c.wheel.poisson = section.number_or("wheel_poisson", c.rail.poisson, Range::between(0.0, 0.5));
  const double wheel = section.number("wheel_radius_m", Range::positive());
  const double crown = section.number_or("rail_crown_radius_m", 0.0, Range::positive());
  c.geometry = read_geometry(section, wheel, crown);
  if (crown > 0 && !c.geometry.profiles.empty())
    section.fail("rail_crown_radius_m", "a crown radius beside profiles says the same thing twice", "take one of them");
  if (crown > 0) c.hertz = hertz_ellipse(wheel, crown, c.wheel, c.rail, c.normal_force);
  c.grid = read_grid(section.section("grid"), c.hertz);
  if (section.choice_or("bodies", "half_space", {"half_space", "blocks"}) == "blocks") c.bodies = ContactBodies::blocks;
  if (section.choice_or("motion", "rolling", {"rolling", "shift"}) == "shift") {
    c.motion = ContactMotion::shift;
    c.shift_x = section.number_or("longitudinal_shift_m", 0.0);
    c.shift_y = section.number_or("lateral_shift_m", 0.0);
  } else {
    c.creepage = read_creepage(section);
    c.curve_factors = section.numbers_or("curve_factors", {});
  }
  section.finish();
  return c;
}

}  // namespace fem
