// What all coupling schemes have in common: the interface to the run, the exchange with the sides, the histories.
//
// One class per family derives from it: robin.hpp (R1, R2), staggered.hpp (E0, E1, E2), iterated.hpp (implicit),
// one_way.hpp, dual_schur.hpp (GC, PH). Formulas: coupler/README.md "Schemes".
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "coupler/scheme/scheme_state.hpp"
#include "coupler/scheme/side.hpp"
#include "coupler/scheme/window_record.hpp"
#include "proto/case/coupling.hpp"
#include "proto/pad/pad_law.hpp"

namespace coupler {

/// What a scheme is made for. `window_s` > 0, `sub_cycles` >= 1: that stability asks for in the first window, and in
/// all if the explicit side names no step of its own (Result.largest_step_s).
struct SchemeSetup {
  double window_s = 0.0;
  std::uint32_t sub_cycles = 1;
  std::vector<proto::PadLaw> laws;  ///< of every interface value, as the pad's owner registered it
  proto::Prolongation prolongation = proto::Prolongation::linear;
  std::uint32_t sub_cycle_factor = 1;  ///< how many times as many are taken
  bool fixed_sub_cycles = false;       ///< the first window's number holds for all; more needed is an error
};

/// What the rail's pad is held against: window means of the sleeper's motion [m], [m/s]; and the carry to subtract [N].
struct RobinTarget {
  std::vector<double> displacement, velocity, carry;
};

/// Runs windows. The object survives a throw of a side only in the sense that it can be destroyed.
class CouplingScheme {
 public:
  explicit CouplingScheme(SchemeSetup setup);
  virtual ~CouplingScheme() = default;

  /// Sets the values at time 0 and forgets what was carried. Throws proto::Error (protocol) for a wrong length.
  void start(const InterfaceState& initial);

  /// Advances both sides through one window and updates what the next one needs; the window is not final yet.
  /// Throws proto::Error: protocol, naming side and field, when a value is missing or has the wrong length; numerics
  /// when an iteration does not converge and the case wants to stop then.
  WindowRecord advance(proto::Phase phase, std::int64_t window, Sides sides);

  /// Makes the window just advanced final on both sides.
  virtual void commit(std::int64_t window, Sides sides) const;

  /// All that a run needs to go on from here, with this scheme or another.
  const SchemeState& state() const { return state_; }
  void resume(SchemeState state) { state_ = std::move(state); }
  void exchange(proto::StateArchive& archive) { state_.exchange(archive, n_values()); }

 protected:
  /// Solves the window of `record` (phase, window and sub_cycles are set), as often as it takes, and fills the record.
  virtual void solve(WindowRecord& record, Sides sides) = 0;

  std::size_t n_values() const { return setup_.laws.size(); }
  double window_s() const { return setup_.window_s; }
  const std::vector<proto::PadLaw>& laws() const { return setup_.laws; }

  /// Requests of iteration `iteration` of the window of `record`.
  proto::Advance force_request(const WindowRecord& record, std::uint32_t iteration, std::vector<double> force) const;
  proto::Advance robin_request(const WindowRecord& record, std::uint32_t iteration, RobinTarget target) const;
  /// Along the path from u_n to the displacement at the window's end in `record`.
  proto::Advance path_request(const WindowRecord& record, std::uint32_t iteration) const;

  /// Write what a side found into `record`; times add up over the iterations.
  void take_rail(WindowRecord& record, const proto::Result& rail) const;
  void take_sleeper(WindowRecord& record, const proto::Result& sleeper);
  void solve_rail(WindowRecord& record, const proto::Advance& request, Side& side) const;
  void solve_sleeper(WindowRecord& record, const proto::Advance& request, Side& side);

  static void roll_back(const WindowRecord& record, Sides sides);

  SchemeState state_;

 private:
  void update(const WindowRecord& record);
  /// Sub-cycles of the next window.
  void take_step(double largest_step_s);

  SchemeSetup setup_;
};

/// The scheme of that name; all else, prolongation and sub_cycle_factor of `setup` too, as `coupling` says.
std::unique_ptr<CouplingScheme> make_scheme(proto::Scheme scheme, const proto::Coupling& coupling, SchemeSetup setup);

/// 2 F_n-1 - F_n-2: means live at mid-windows, so this is the linear extrapolation [N].
std::vector<double> extrapolated_force(const SchemeState& state);

/// Euclidean norm.
double norm(const std::vector<double>& values);

/// Smallest number of sub-cycles whose step does not exceed `largest_step_s`; 1 when the participant named no limit.
/// Throws proto::Error (numerics) for a limit that is not positive or needs more than 1e6 sub-cycles.
std::uint32_t sub_cycles_for(double window_s, std::optional<double> largest_step_s);

}  // namespace coupler
