// What lies under sleeper and ballast, as a case gives it.
#pragma once

#include <string>

#include "proto/case/case_file.hpp"
#include "qdem_solver/bed/bed.hpp"

namespace qdem {

/// Reads
///   [qdem.under_sleeper_pad], [qdem.under_ballast_mat] bedding_modulus_n_per_m3, footprint_m2, shear_ratio (0.3),
///     loss_factor (0) with loss_factor_frequency_hz: a footprint's k = bedding modulus x its area, c = loss factor
///     k/(2 pi f); along the surface shear_ratio times both
///   [qdem.subgrade] kind ("rigid"; "half_space" with material, one of [[qdem.material]], and footprint_radius_m;
///     "layer" with material, thickness_m, width_m, element_m, boundary_stiffness ([1.0, 0.5]: normal, tangential),
///     highest_frequency_hz (0: not asked))
/// into physics.lining, physics.ground, mat and half-space in series, and physics.subgrade. The materials must have
/// been read. Throws proto::Error (config).
void read_layers(const proto::Section& qdem, BedPhysics& physics);

/// Refuses what a layer of elements cannot be together with. The contact law must have been read. Throws proto::Error
/// (config).
void check_subgrade(const proto::Section& qdem, const BedPhysics& physics);

/// Name of the subgrade's material; empty without one.
std::string subgrade_material(const proto::Section& qdem);

}  // namespace qdem
