// `[fem]` and `[wheel]` of the case file.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fem_solver/contact/hertz.hpp"
#include "fem_solver/contact/patch_settings.hpp"
#include "fem_solver/model/irregularity.hpp"
#include "fem_solver/model/material.hpp"
#include "proto/case/case_file.hpp"
#include "proto/case/rail_seat.hpp"

namespace fem {

/// What a seat that QDEM does not carry stands on: pad cells as of the coupled seats, a rigid half sleeper with three
/// translations, a spring and a dashpot to the ground per direction. Components: longitudinal, lateral, vertical.
struct SupportSettings {
  Eigen::Vector2d pad_half_lengths{0.075, 0.07};  ///< [m]
  Eigen::Vector2i pad_cells{3, 3};
  Eigen::Vector3d pad_stiffness{60e6, 60e6, 225e6};      ///< whole pad [N/m]
  Eigen::Vector3d pad_damping{15e3, 15e3, 30e3};         ///< whole pad [N s/m]
  double sleeper_mass = 150.0;                           ///< half sleeper [kg]
  Eigen::Vector3d ballast_stiffness{50e6, 50e6, 150e6};  ///< [N/m]
  Eigen::Vector3d ballast_damping{48e3, 48e3, 48e3};     ///< [N s/m]
};

struct FemSettings {
  std::string profile = "60E1";
  int n_bays = 16;
  double element_length = 0.1;  ///< largest; the mesh takes a whole number of elements per bay [m]
  Material material;
  double loss_factor = 0.02;
  double loss_factor_frequency = 1000.0;  ///< where the stiffness-proportional damping has the loss factor [Hz]
  bool gravity = true;                    ///< weight of the rail
  double end_dashpot_frequency = 500.0;   ///< the rail ends absorb bending waves of this frequency; 0: free ends [Hz]
  double initialise_damping = 2000.0;     ///< mass-proportional, only before time 0 [1/s]
  double sleeper_spacing = 0.6;           ///< from [track] [m]
  SupportSettings support;
};

struct WheelSettings {
  double speed = 40.0;             ///< [m/s]
  double start = -2.0;             ///< x at time 0 [m]
  double static_load = 65e3;       ///< [N]
  double unsprung_mass = 600.0;    ///< [kg]
  double radius = 0.43;            ///< [m]
  double rail_crown_radius = 0.3;  ///< [m]
  ElasticBody wheel, rail;
  Irregularity irregularity;
  std::optional<PatchSettings> patch;  ///< the contact resolved; none: Hertz's spring
  double longest_contact_loss = std::numeric_limits<double>::infinity();  ///< a longer one ends the run [s]
};

/// Reads `[fem]`: profile, n_bays, element_length_m, young_pa, poisson, density_kg_per_m3, loss_factor,
/// loss_factor_frequency_hz, gravity, end_dashpot_frequency_hz, initialise_damping_per_s and
/// [fem.support]: pad_stiffness_n_per_m, pad_damping_ns_per_m, pad_cells (default: those of the first rail seat),
/// sleeper_mass_kg, ballast_stiffness_n_per_m, ballast_damping_ns_per_m. Spacing from [track].
FemSettings read_fem(const proto::CaseFile& file, const std::vector<proto::RailSeat>& seats);

/// Reads `[wheel]`: speed_m_per_s, start_m, static_load_n, unsprung_mass_kg, radius_m, rail_crown_radius_m, young_pa,
/// poisson, contact ("hertz" or "patch" with [wheel.patch]), longest_contact_loss_s and [wheel.irregularity]: kind,
/// depth_m, length_m, position_m | amplitude_m, wavelength_m, begin_m | file.
WheelSettings read_wheel(const proto::CaseFile& file, const Material& rail);

/// JSON Schema of all that these two read.
std::string fem_schema();

}  // namespace fem
