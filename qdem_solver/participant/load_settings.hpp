// `[[qdem.run.load]]`: what is done to the bed when it runs alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

enum class LoadTarget { pads, patch };

struct LoadSettings {
  LoadTarget target = LoadTarget::pads;
  PatchLoad load;                       ///< all but the patch
  std::string body = "sleeper";         ///< of a patch
  Region region;                        ///< of a patch
  Eigen::Vector3d direction{0, 0, -1};  ///< of a patch
};

/// Whether it is one of Model::loads: loads on patches, and drop weights on the pads.
inline bool acts_on_patch(const LoadSettings& of_case) {
  return of_case.target == LoadTarget::patch || of_case.load.kind == LoadKind::drop_weight;
}

/// Reads the tables `[[qdem.run.load]]` of `run`:
///     on = "pads"         of all seats together, downward (default)
///     on = "patch"        body ("sleeper"), centre_m, radius_m or half_lengths_m, direction ([0, 0, -1])
///     kind = "table"      time_s (ascending), force_n: linear between, constant outside
///     kind = "half_sine"  peak_n, duration_s, start_s (0): an impulse of 2/pi peak duration
///     kind = "cyclic"     mean_n, amplitude_n, frequency_hz, cycles; start_s (0): the mean is reached by then, and
///                         sine waves run about it; after the last cycle the force stays as it ends
///     kind = "displacement_table"  time_s, displacement_m
///     kind = "displacement_sine"   mean_m, amplitude_m, frequency_hz, cycles, start_s, as "cyclic"
///         on pads: of the rail foot; on a patch: of the far end of a spring of stiffness_n_per_m
///     kind = "drop_weight" mass_kg, drop_height_m or impact_velocity_m_per_s, stiffness_n_per_m, damping_ns_per_m (0)
///                         of its buffer, start_s (0) when it first touches; on the pads' area or a patch
/// `gravity` [m/s2] turns a drop height into a speed. Throws proto::Error (config).
std::vector<LoadSettings> read_loads(const proto::Section& run, double gravity);

/// The loads that act on patches at `state`. Model::pads must be there.
/// Throws proto::Error (bad_data) for a body or a patch that is not there.
std::vector<PatchLoad> make_patch_loads(const Model& model, const State& state,
                                        const std::vector<LoadSettings>& settings);

}  // namespace qdem
