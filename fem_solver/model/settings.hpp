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
#include "fem_solver/model/rail_section.hpp"
#include "fem_solver/model/tread.hpp"
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
  bool pad_tension_cutoff = false;                       ///< the pad lets go where the clip's preload is used up
  double pad_clip_preload = 0.0;                         ///< whole pad [N]
  double pad_second_stiffness = 0.0;                     ///< whole pad, normal, when pressed further; 0: linear [N/m]
  double pad_second_begin = 0.0;                         ///< compression where it begins [m]
  double sleeper_mass = 150.0;                           ///< half sleeper [kg]
  Eigen::Vector3d ballast_stiffness{50e6, 50e6, 150e6};  ///< [N/m]
  Eigen::Vector3d ballast_damping{48e3, 48e3, 48e3};     ///< [N s/m]

  bool linear_pads() const { return !pad_tension_cutoff && pad_second_stiffness == 0.0; }
};

struct FemSettings {
  std::string profile = "60E1";  ///< a name, or the path of an outline
  bool profile_is_file = false;
  int n_bays = 16;
  double element_length = 0.1;  ///< largest; the mesh takes a whole number of elements per bay [m]
  Material material;
  double loss_factor = 0.02;
  double loss_factor_frequency = 1000.0;  ///< where the stiffness-proportional damping has the loss factor [Hz]
  bool gravity = true;                    ///< weight of the rail
  double end_dashpot_frequency = 500.0;   ///< the rail ends absorb bending waves of this frequency; 0: free ends [Hz]
  int end_layer_bays = 0;                 ///< bays of an absorbing layer beyond each end of the refined rail
  double end_layer_element_length = 0.3;  ///< largest in the layers of the solid rail [m]
  double end_layer_damping = 3e3;         ///< mass-proportional damping at the layer's outer end [1/s]
  double initialise_damping = 2000.0;     ///< mass-proportional, only before time 0 [1/s]
  double sleeper_spacing = 0.6;           ///< from [track] [m]
  SupportSettings support;

  /// Throws what rail_section() or rail_section_from_file() throws.
  RailSection section() const { return profile_is_file ? rail_section_from_file(profile) : rail_section(profile); }
};

/// Spring and dashpot between axle box and bogie.
struct SuspensionSettings {
  double stiffness = 0.0;    ///< 0: none, the static load rests on the unsprung mass itself [N/m]
  double damping = 0.0;      ///< [N s/m]
  double sprung_mass = 0.0;  ///< that moves on it [kg]
};

enum class WheelKind { mass, solid };

/// The wheel as a body of revolution: a tread profile on a rim, a web and a hub.
struct SolidWheelSettings {
  TreadKind tread = TreadKind::s1002;
  std::vector<double> web_radius{0.095, 0.125, 0.15, 0.25, 0.34, 0.375};     ///< bore to rim, ascending [m]
  std::vector<double> web_thickness{0.17, 0.17, 0.05, 0.026, 0.026, 0.040};  ///< there [m]
  double density = 7850.0;                                                   ///< [kg/m3]
  double loss_factor = 2e-3;                                                 ///< of every mode
};

struct WheelSettings {
  double speed = 40.0;             ///< [m/s]
  double start = -2.0;             ///< x at time 0 [m]
  double static_load = 65e3;       ///< [N]
  double unsprung_mass = 600.0;    ///< [kg]
  double radius = 0.43;            ///< [m]
  double rail_crown_radius = 0.3;  ///< [m]
  ElasticBody wheel, rail;
  Irregularity irregularity;  ///< of the rail
  Irregularity defect;        ///< of the wheel
  SuspensionSettings suspension;
  WheelKind kind = WheelKind::mass;
  SolidWheelSettings solid;
  std::optional<PatchSettings> patch;  ///< the contact resolved; none: Hertz's spring
  double longest_contact_loss = std::numeric_limits<double>::infinity();  ///< a longer one ends the run [s]

  /// Relative displacement that rail and wheel impose at x [m].
  double height_at(double x) const { return irregularity.height_at(x) + defect.height_at(x); }
};

/// Reads `[fem]`: profile or profile_file, n_bays, element_length_m, young_pa, poisson, density_kg_per_m3, loss_factor,
/// loss_factor_frequency_hz, gravity, end_dashpot_frequency_hz, end_layer_bays, end_layer_element_length_m,
/// end_layer_damping_per_s, initialise_damping_per_s and
/// [fem.support]: pad_stiffness_n_per_m, pad_damping_ns_per_m, pad_cells (default: those of the first rail seat),
/// pad_tension_cutoff, pad_clip_preload_n, pad_second_stiffness_n_per_m, pad_second_begin_m,
/// sleeper_mass_kg, ballast_stiffness_n_per_m, ballast_damping_ns_per_m. Spacing from [track].
FemSettings read_fem(const proto::CaseFile& file, const std::vector<proto::RailSeat>& seats);

/// Reads `[wheel]`: speed_m_per_s, start_m, static_load_n, unsprung_mass_kg, radius_m, rail_crown_radius_m, young_pa,
/// poisson, model, contact ("hertz" or "patch" with [wheel.patch]), longest_contact_loss_s; [wheel.irregularity]: kind,
/// depth_m, length_m, position_m | amplitude_m, wavelength_m, begin_m | file; [wheel.defect]: kind, length_m, depth_m,
/// position_m | amplitude_m, order, begin_m; [wheel.suspension]: stiffness_n_per_m, damping_ns_per_m, sprung_mass_kg;
/// [wheel.solid]: tread, web_file, density_kg_per_m3, loss_factor.
WheelSettings read_wheel(const proto::CaseFile& file, const Material& rail);

/// JSON Schema of all that these two read.
std::string fem_schema();

}  // namespace fem
