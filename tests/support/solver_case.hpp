// A case of the real solvers that is small enough for fault tests: a bed of some thirty large, soft stones that is
// built in ten seconds, a rail of five bays, a standing wheel.
#pragma once

#include <string>

#include "tests/support/case_changes.hpp"

namespace tests {

/// Marches through 1e7 windows, after an initialise phase that counts anything as rest. Its bed may be as it comes.
inline std::string solver_case(const CaseChanges& changes = {}) {
  return with_changes(R"([coupling]
window_s = 1e-4
duration_s = 1000.0
output_interval_s = 1e-3

[coupling.initialise]
max_windows = 100000000
min_windows = 0
check_windows = 5
tolerance = 1e9
qdem_residual_limit = 1e9
fem_residual_limit = 1e9

[track]
gauge_m = 0.3
sleeper_spacing_m = 0.38

[[rail_seat]]
name = "seat"
origin_m = [0.0, 0.1, 0.0]
half_lengths_m = [0.05, 0.05]
cells = [2, 2]
stiffness_n_per_m = [6e6, 6e6, 20e6]
damping_ns_per_m = [2e3, 2e3, 4e3]

[bed]
seed = 1
sleeper_length_m = 0.4
sleeper_width_m = 0.14
sleeper_height_m = 0.1
sleeper_cells_through_height = 2
depth_m = 0.12
crib_height_m = 0.02
shoulder_width_m = 0.05
shoulder_slope = 1.0
templates = 2
elements_per_stone = [20, 80]
sieve_sizes_m = [0.09, 0.11]
sieve_passing_percent = [0, 100]
preload_n = 500
ramp_levels = 2
ramp_steps = 200
rest_steps = 1000
porosity_limits = [0.1, 0.9]
unbalanced_limit = 0.5
kinetic_energy_limit_j = 10.0
penetration_limit_m = 0.01
sleeper_tilt_limit_rad = 0.2

[qdem]
threads = 1

[[qdem.material]]
name = "stone"
young_pa = 1e9
poisson = 0.25
density_kg_per_m3 = 2700
retardation_time_s = 1e-6

[[qdem.material]]
name = "sleeper"
young_pa = 1e9
poisson = 0.2
density_kg_per_m3 = 2400
retardation_time_s = 1e-6

[qdem.contact]
normal_stiffness_n_per_m = 1e6
damping_ratio = 0.05
friction = 0.6
rounding_m = 1e-3

[fem]
n_bays = 4
element_length_m = 0.38

[wheel]
speed_m_per_s = 0.0
start_m = 0.0
static_load_n = 5e3
unsprung_mass_kg = 100.0
radius_m = 0.43
)",
                      changes);
}

}  // namespace tests
