// `[contact]` of a case file: one contact of wheel and rail, looked at alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fem_solver/contact/contact_gap.hpp"
#include "fem_solver/contact/patch_ellipse.hpp"
#include "fem_solver/contact/rolling.hpp"
#include "proto/case/case_file.hpp"

namespace fem {

enum class ContactMotion { rolling, shift };
enum class ContactBodies { half_space, blocks };

/// What is asked of a contact.
struct ContactCase {
  ContactGeometry geometry;
  ElasticBody wheel, rail;
  double normal_force = 0.0;          ///< [N]
  double friction = 0.0;              ///< Coulomb's coefficient
  std::optional<PatchEllipse> hertz;  ///< where both radii are given
  PatchGrid grid;
  ContactBodies bodies = ContactBodies::half_space;
  ContactMotion motion = ContactMotion::rolling;
  Creepage creepage;                    ///< of steady rolling
  std::vector<double> curve_factors;    ///< each times `creepage` is a point of the creep-force curve
  double shift_x = 0.0, shift_y = 0.0;  ///< of the wheel over the rail, without rolling [m]
};

/// Surfaces of `section`: wheel_profile and rail_profile (files y_m, z_m) with wheel_shift_m, or none of them. Wheel
/// and crown radius [m] come from elsewhere; a crown radius of 0 is flat.
ContactGeometry read_geometry(const proto::Section& section, double wheel_radius, double crown_radius);

/// A friction coefficient, 0 to 1: anything else is refused with the place of the key.
double read_friction(const proto::Section& section);

/// longitudinal_creepage, lateral_creepage, spin_per_m; 0 without.
Creepage read_creepage(const proto::Section& section);

/// Reads `[contact]`: normal_force_n, friction, wheel_radius_m, rail_crown_radius_m (flat without), wheel_profile,
/// rail_profile, wheel_shift_m, young_pa, poisson (of the rail), wheel_young_pa, wheel_poisson, bodies ("half_space";
/// "blocks" of finite elements), motion ("rolling": longitudinal_creepage, lateral_creepage, spin_per_m, curve_factors;
/// "shift": longitudinal_shift_m, lateral_shift_m) and [contact.grid]: elements_per_semi_axis, margin (around Hertz's
/// ellipse), or elements and element_m. Throws proto::Error (config, missing_input, bad_data).
ContactCase read_contact(const proto::CaseFile& file);

}  // namespace fem
