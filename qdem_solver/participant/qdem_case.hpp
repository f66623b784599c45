// `[qdem]`: materials, contact, integration, and the run without a coupler.
#pragma once

#include <vector>

#include "proto/case/case_file.hpp"
#include "qdem_solver/bed/bed.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/participant/load_settings.hpp"
#include "qdem_solver/sensors/sensor_settings.hpp"

namespace qdem {

/// `[qdem.run]`: what `qdem_solver run` does with the bed.
struct RunAlone {
  double duration = 0.0;         ///< [s]
  double output_interval = 0.0;  ///< [s]; 0: only the last state
  std::vector<LoadSettings> loads;
};

struct QdemCase {
  BedPhysics physics;
  double step_safety = 0.8;   ///< share of the computed stability bound
  double largest_step = 0.0;  ///< the user's own limit [s]; 0: none
  EngineKind engine = EngineKind::cpu;
  int threads = 0;                      ///< 0: as many as the environment gives
  double initial_overlap_limit = 0.01;  ///< of two bodies at the start, over the edge of their elements [-]
  double initialise_damping = 0.5;      ///< Cundall's damping in the initialise phase [-]
  int steps_per_viscous_sample = 16;    ///< see EngineOptions
  SensorsSettings sensors;
  bool contact_output = false;  ///< contacts.h5 beside every output of the fields
  RunAlone run;
};

/// Reads
///   [qdem] particle_interaction ("quadruple", "bond"), engine ("cpu", "cuda", "check"), step_safety, largest_step_s,
///     threads, gravity_m_per_s2, initialise_damping, steps_per_viscous_sample, sensor_interval_s, contact_output
///   [[qdem.sensor]] (sensors/sensor_settings.hpp)
///   [[qdem.material]] name ("stone", "sleeper"; others where [bed] stone_materials or [qdem.subgrade] names them; each
///   once), young_pa, poisson, density_kg_per_m3, and one of
///     retardation_time_s; loss_factor with loss_factor_frequency_hz; lame_viscosity_pa_s with shear_viscosity_pa_s
///   [qdem.contact] normal_stiffness_n_per_m, or hertz_load_n with hertz_radius_m (tangent of Hertz's law there), or
///     contact_time_s with contact_mass_kg (of two stones of that mass); damping_ratio or restitution;
///     tangential_ratio, friction, ground_friction, rounding_m, initial_overlap_limit; law ("facet", "sphere"), with
///     spheres sphere_radii ("equal", "by_edge"), rolling_friction
///   [qdem.under_sleeper_pad], [qdem.under_ballast_mat], [qdem.subgrade] (layers_case.hpp)
///   [qdem.run] duration_s, output_interval_s
///   [[qdem.run.load]] (load_settings.hpp)
/// and refuses every other key. Throws proto::Error (config).
QdemCase read_qdem_case(const proto::CaseFile& file);

}  // namespace qdem
