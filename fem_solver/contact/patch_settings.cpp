#include "fem_solver/contact/patch_settings.hpp"

#include "fem_solver/contact/contact_case.hpp"

namespace fem {

using proto::Range;

PatchSettings read_patch(const proto::Section& section, double wheel_radius, double crown_radius) {
  PatchSettings s;
  s.geometry = read_geometry(section, wheel_radius, crown_radius);
  s.friction = read_friction(section);
  s.creepage = read_creepage(section);
  if (section.has("torque_nm"))
    s.drive = WheelDrive{section.number("torque_nm"), section.number("polar_inertia_kg_m2", Range::positive())};
  s.elements_per_semi_axis =
      static_cast<int>(section.integer_or("elements_per_semi_axis", s.elements_per_semi_axis, Range::between(8, 40)));
  s.grid_margin = section.number_or("grid_margin", s.grid_margin, Range::between(1.0, 4.0));
  s.record_interval = section.number_or("record_interval_s", s.record_interval, Range::not_negative());
  return s;
}

}  // namespace fem
