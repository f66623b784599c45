// `[wheel.patch]` of a case file: the wheel's contact as a resolved patch.
#pragma once

#include <optional>

#include "fem_solver/contact/contact_gap.hpp"
#include "fem_solver/contact/rolling.hpp"
#include "proto/case/case_file.hpp"

namespace fem {

/// A wheel whose speed of rotation follows from a torque.
struct WheelDrive {
  double torque = 0.0;         ///< on the wheel, positive drives it forward (traction), negative brakes [N m]
  double polar_inertia = 0.0;  ///< about its axle [kg m2]
};

struct PatchSettings {
  ContactGeometry geometry;
  double friction = 0.3;            ///< Coulomb's coefficient
  Creepage creepage;                ///< prescribed; with a drive the longitudinal one is what rotation starts with
  std::optional<WheelDrive> drive;  ///< none: prescribed rotation
  int elements_per_semi_axis = 8;   ///< of Hertz's ellipse under the static load
  double grid_margin = 1.6;         ///< width of the grid over that ellipse's
  double record_interval = 0.0;     ///< between records of the patch's fields; 0: none [s]
};

/// Reads friction, longitudinal_creepage, lateral_creepage, spin_per_m, torque_nm with polar_inertia_kg_m2,
/// wheel_profile, rail_profile, wheel_shift_m, elements_per_semi_axis, grid_margin, record_interval_s. Throws
/// proto::Error (config, missing_input, bad_data).
PatchSettings read_patch(const proto::Section& section, double wheel_radius, double crown_radius);

}  // namespace fem
