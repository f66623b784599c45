// `[bed]` of the case file and the geometry it implies.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "proto/case/rail_seat.hpp"
#include "qdem_solver/bed/gradation.hpp"
#include "qdem_solver/bed/sleeper_shape.hpp"
#include "qdem_solver/bed/stone_shape.hpp"
#include "qdem_solver/model/model.hpp"

namespace qdem::bed {

/// What is modelled.
enum class Scene {
  ballast,  ///< the sleeper in its bed
  sleeper,  ///< the sleeper alone
  stone,    ///< one stone
};

/// Every key of `[bed]`, SI. README.md lists the keys with their defaults.
struct Settings {
  Scene scene = Scene::ballast;
  std::uint64_t seed = 1;
  std::optional<Interaction> poured_with;  ///< law of the bodies while the bed is built; none: that of the run

  SleeperShape sleeper;
  int sleeper_cells = 4;  ///< through its height

  double depth = 0;           ///< of ballast under the sleeper [m]
  double crib_height = 0;     ///< of ballast beside the sleeper, above its bottom [m]
  double shoulder_width = 0;  ///< beyond the sleeper's end, at crib height [m]
  double shoulder_slope = 0;  ///< horizontal per vertical [-]

  Gradation gradation;
  StoneShapes shapes;
  std::vector<Ingredient> mixture{Ingredient{}};  ///< of the stones' materials

  double target_porosity = 0;  ///< the stones are drawn for [-]
  double pour_speed = 0;       ///< drag limits falling stones to it [m/s]
  double pour_young = 0;       ///< of stones while they are poured [Pa]
  double pour_stiffness = 0;   ///< contact stiffness while they are poured [N/m]
  double pour_friction = 0;    ///< while they are poured and tamped [-]
  double pour_swelling = 0;    ///< stones are poured larger by this share; at true size soft contacts part [-]
  int ramp_levels = 0;         ///< from soft to real stiffness
  int ramp_steps = 0;          ///< of each level
  double preload = 0;          ///< largest load on the half sleeper while the bed is consolidated [N]
  int preload_cycles = 0;      ///< how often it comes and goes
  int preload_steps = 0;       ///< in which it comes, and in which it goes
  int rest_steps = 0;          ///< at most, until the bed is at rest

  double porosity_lowest = 0, porosity_highest = 0;  ///< limits of the result [-]
  double unbalanced_limit = 0;                       ///< of the result [-]
  double kinetic_limit = 0;                          ///< of the result [J]
  double penetration_limit = 0;                      ///< of the result; 0: twice the contact rounding [m]
  double tilt_limit = 0;                             ///< of the result [rad]

  double spacing = 0;  ///< of sleepers, the bay's length [m]
  std::vector<proto::RailSeat> seats;

  double half_length() const { return sleeper.half_length(); }
  double ground_level() const { return -sleeper.height() - depth; }      ///< z [m]
  double crib_level() const { return -sleeper.height() + crib_height; }  ///< z [m]
  /// Foot of the shoulder's slope: y of the formwork's wall [m].
  double wall() const { return half_length() + shoulder_width + shoulder_slope * (depth + crib_height); }
};

/// Names of the case's materials in the order of BedPhysics::materials(): "stone", "sleeper", then the others as they
/// come in [[qdem.material]].
std::vector<std::string> material_names(const proto::CaseFile& file);

/// Reads and checks [bed], [track] and the rail seats. Throws proto::Error (config).
Settings read_settings(const proto::CaseFile& file);

}  // namespace qdem::bed
