// The explicit coupling schemes: what each side gets in a window, and what is carried to the next.
//
// Per window, in this order: implicit side (rail), explicit side (sleeper). Formulas: formulation of this project,
// coupler/README.md "Schemes".
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "coupler/scheme/side.hpp"
#include "coupler/scheme/window_record.hpp"
#include "proto/case/coupling.hpp"
#include "proto/pad/pad_law.hpp"
#include "proto/result/state_archive.hpp"

namespace coupler {

/// Interface values at one instant.
struct InterfaceState {
  std::vector<double> rail_displacement, rail_velocity;        ///< [m], [m/s]
  std::vector<double> sleeper_displacement, sleeper_velocity;  ///< [m], [m/s]
};

/// Runs windows of R1 (Robin explicit with cumulative carry), R2 (R1 and one corrector), E1 (conventional serial
/// staggered) or E2 (E1 with the mean force extrapolated).
///
/// The object survives a throw of a side only in the sense that it can be destroyed.
class WindowScheme {
 public:
  /// `laws`: the pad law of every interface value, as its owner registered it. `window_s` > 0, `sub_cycles` >= 1: of
  /// the first window, and of all if the explicit side names no step of its own (Result.largest_step_s).
  WindowScheme(proto::Scheme scheme, double window_s, std::uint32_t sub_cycles, std::vector<proto::PadLaw> laws);

  /// Sets the values at time 0 and forgets what was carried. Throws proto::Error (protocol) for a wrong length.
  void start(const InterfaceState& initial);

  /// Advances both sides through one window and updates what the next one needs; commits nothing.
  /// Throws proto::Error (protocol) naming side and field when a value is missing or has the wrong length.
  WindowRecord advance(proto::Phase phase, std::int64_t window, Sides sides);

  /// All that the next window needs of the earlier ones.
  void exchange(proto::StateArchive& archive);

 private:
  proto::Advance implicit_request(proto::Phase phase, std::int64_t window) const;
  /// R2: the rail again, against the mean force that the sleeper's side found in `record` and the pad's law about it.
  proto::Advance corrected_request(const WindowRecord& record) const;
  proto::Advance explicit_request(const WindowRecord& record, std::uint32_t iteration) const;
  void set_robin(proto::Advance& request, std::vector<double> displacement, std::vector<double> velocity) const;
  void solve_implicit(WindowRecord& record, const proto::Advance& request, Side& side) const;
  void solve_explicit(WindowRecord& record, const proto::Advance& request, Side& side);
  std::vector<double> expected_force() const;  ///< E1, E2: of the next window [N]
  void predict_sleeper(std::vector<double>& mean_displacement, std::vector<double>& mean_velocity) const;
  void update(const WindowRecord& record);

  proto::Scheme scheme_;
  double window_s_;
  std::uint32_t sub_cycles_;  ///< of the next window
  std::vector<proto::PadLaw> laws_;
  InterfaceState state_;
  std::vector<double> sleeper_acceleration_;  ///< window mean of the last window [m/s^2]
  std::vector<double> force_carry_;           ///< R1, R2: raw defect of the last window over H [N]
  std::vector<double> force_mean_;            ///< E1, E2: mean pad force of the last window [N]
  std::vector<double> force_mean_before_;     ///< E2: of the one before [N]
  bool rail_known_ = false;                   ///< false until the rail's displacement was heard for the first time
};

/// Smallest number of sub-cycles whose step does not exceed `largest_step_s`; 1 when the participant named no limit.
/// Throws proto::Error (numerics) for a limit that is not positive or needs more than 1e6 sub-cycles.
std::uint32_t sub_cycles_for(double window_s, std::optional<double> largest_step_s);

}  // namespace coupler
