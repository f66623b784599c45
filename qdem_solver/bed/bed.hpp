// The ballast bed at rest under its sleeper: built once by the QDEM solver itself, then loaded from a cache.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "qdem_solver/bed/subgrade.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// What the bed has to know of `[qdem]`; whoever reads that section hands it over.
struct BedPhysics {
  Material stone, sleeper;
  std::vector<Material> others;  ///< further materials that a case names
  ContactLaw contact;            ///< between bodies, at real stiffness; also the planes' k_n, k_t, damping, rounding
  double ground_friction = 0.5;  ///< of the plane under the ballast [-]
  Bearing lining;                ///< under-sleeper pad
  Bearing ground;                ///< behind the plane under the ballast: mat, half-space
  std::optional<SubgradeLayer> subgrade;  ///< of elements, in that plane's place
  Eigen::Vector3d gravity{0, 0, -9.81};   ///< [m/s2]

  /// All materials as Model::materials holds them: stone, sleeper, others, that of the subgrade's elements.
  std::vector<Material> materials() const {
    std::vector<Material> all{stone, sleeper};
    all.insert(all.end(), others.begin(), others.end());
    if (subgrade) all.push_back(subgrade->material);
    return all;
  }
};

/// Figures of a finished bed. All are stored in the bed file, so a loaded bed reports what the built one did.
struct BedReport {
  std::int64_t stones = 0;
  std::int64_t elements = 0;  ///< tetrahedra of stones and sleeper
  std::int64_t seed = 0;
  double porosity_under_sleeper = 0.0;  ///< in a probe box under the sleeper, clear of its boundaries [-]
  double porosity_layer = 0.0;          ///< in the whole layer under the sleeper's bottom level, clear of walls [-]
  double coordination_number = 0.0;     ///< mean number of other bodies a stone touches [-]
  double largest_penetration = 0.0;     ///< of the rounded surfaces [m]
  double unbalanced_force_ratio = 0.0;  ///< mean net force on a stone / mean sum of contact force sizes on a stone [-]
  double kinetic_energy = 0.0;          ///< of all bodies [J]
  double d50 = 0.0;                     ///< sieve size that half of the stones' mass passes [m]
  double elements_per_stone = 0.0;
  double sleeper_settlement = 0.0;  ///< downward move of the sleeper while the bed was consolidated [m]
  double stiffness = 0.0;      ///< of the bed: preload over the sleeper's rise as the last one was taken away [N/m]
  double sleeper_shift = 0.0;  ///< along the track, taken out by shifting the bed [m]
  double sleeper_tilt = 0.0;   ///< pitch about the lateral axis that is left [rad]
  double build_wall_s = 0.0;
  std::string hash;                ///< of the inputs, 16 hexadecimal digits
  bool from_cache = false;         ///< not stored
  std::vector<std::string> notes;  ///< e.g. templates rejected and why
};

/// A bed at rest: time 0, velocities of the last relaxation step as they are, contact history kept.
///
/// Body 0 is the sleeper (`model.pad_body` = 0), bodies 1.. are stones. `model.materials` are BedPhysics::materials().
/// Planes: "ground", "symmetry" (y = 0, stones only), "bay_begin", "bay_end". Fixities hold the sleeper's cut at u_y =
/// 0. On a subgrade of elements there is a last body more, see lay_subgrade(). No pads: the caller adds them. Local
/// damping and drag are zero.
struct Bed {
  Model model;
  State state;
  BedReport report;
};

/// Builds the bed of `file` ([bed], [track], [[rail_seat]]) or loads it from the cache when a bed with the same inputs
/// is there; a scene of one body ([bed] scene) is made anew every time. Same inputs give bitwise the same bed, built or
/// loaded, with any number of threads. A bed on a subgrade of elements is first made on rigid ground, in the cache too,
/// then laid on it and brought to rest anew.
///
/// The cache is `cache_folder`, by default $QDEM_BED_CACHE, else $XDG_CACHE_HOME/qdem_fem/beds, else .cache/beds under
/// the working folder. Throws proto::Error: config for bad keys; bad_data when the bed misses a limit of the case
/// (porosity, rest, penetration, sleeper tilt); cannot_create, io_error for the cache.
Bed make_bed(const proto::CaseFile& file, const BedPhysics& physics, const std::string& cache_folder = {});

/// XXH3-64 of every input of the bed, the stone files' content among them: 16 hexadecimal digits, the name in the
/// cache. Throws as make_bed for bad keys, missing_input for a stone file that cannot be read.
std::string bed_hash(const proto::CaseFile& file, const BedPhysics& physics);

/// What the case's sleeper weighs and costs by itself, before any bed is built.
struct SleeperFigures {
  double mass = 0.0;        ///< of the whole sleeper as meshed [kg]
  double step_bound = 0.0;  ///< largest stable step of the half sleeper without contacts [s]
};

/// Throws as make_bed for bad keys.
SleeperFigures sleeper_figures(const proto::CaseFile& file, const BedPhysics& physics);

/// Reads and checks [bed] and the geometry it implies without building anything. Returns what deserves a warning, one
/// line each. Throws as make_bed for bad keys.
std::vector<std::string> check_bed(const proto::CaseFile& file, const BedPhysics& physics);

}  // namespace qdem
