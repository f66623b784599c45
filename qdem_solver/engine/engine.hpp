// The time integrator: forces of one model on one state, kick-drift-kick, on the CPU or on a device.
//
// One step from t_n to t_n+1 = t_n + dt:
//     x += dt (v + dt/2 a);  v_pred = v + dt a;  a_new = forces(x, v_pred)/m;  v += dt/2 (a + a_new)
// so that every dashpot acts at the velocity of its force's own time level (second order; a lagged one is first order).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "proto/span.hpp"
#include "qdem_solver/contact/contact_stage.hpp"
#include "qdem_solver/engine/energy_balance.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Who makes the steps.
enum class EngineKind {
  cpu,
  cuda,   ///< a CUDA device
  check,  ///< the kernels of the device engine, run on the host: see device/README.md
};

/// As a case names it.
const char* engine_name(EngineKind kind);

/// Why an engine cannot be used here: not built in, no device. Empty: it can.
std::string why_no_engine(EngineKind kind);

/// What of a model an engine does not know, as one would name it. Empty: it knows everything.
std::string unknown_to_engine(EngineKind kind, const Model& model);

struct EngineOptions {
  int threads = 0;                     ///< OpenMP threads; 0: as many as the environment gives
  std::function<void()> on_step = {};  ///< called after every step, for a device after a call's last; bumps a counter
  /// One of so many steps, taken at random, samples the elements' viscous power, which the ledger takes as linear in
  /// between. Random, because a stone rings at periods of a few steps: samples at equal distances would meet the same
  /// phase again and again. 1: every step.
  int steps_per_viscous_sample = 16;
  EngineKind kind = EngineKind::cpu;
  std::uint64_t check_seed = 1;  ///< of the order in which `check` runs the items of a kernel; 0: ascending
};

/// Motion of the rail foot at the pad cells over one run of steps: linear from `begin` to `end`, values in order of
/// cell, seat axis [m]; 3 x model.pads.size() each.
struct PadDrive {
  proto::Span<const double> begin, end;
};

/// What the pads did over one run of steps, per value in order of cell, seat axis.
struct PadSums {
  std::vector<double> impulse;  ///< of the force on the sleeper: sum dt (f_j + f_j+1)/2 [N s]
  std::vector<double> work;     ///< sum (f_j + f_j+1)/2 (u_j+1 - u_j) [J]
};

struct Energies {
  double kinetic = 0.0;  ///< [J]
  double strain = 0.0;   ///< elastic energy of all elements [J]
};

/// Integrates a State of a Model. Holds scratch only: everything that has a history lives in the State, so that copying
/// the State is a snapshot, and a restored State continues with the same bytes.
///
/// The Model must outlive the engine and keep its bodies, materials, contact law, pads, fixities, loads and boundary.
/// `gravity`, `local_damping`, `inertia`, `drag_per_s`, `pad_body_load` and the planes' velocities are read at every
/// step and may be changed between steps; a change of anything else needs a new engine. Results are bitwise the same
/// for any number of threads.
class Engine {
 public:
  /// Throws proto::Error (unavailable) for a device that is not there, (config) for what a device cannot do.
  explicit Engine(const Model& model, EngineOptions options = {});
  ~Engine();

  /// Builds the contact candidates if they are due and sets state.a from the forces at (state.x, state.v), pads
  /// unloaded. Call it for a fresh state, and after writing x or v from outside. Not for a state with an open ledger.
  void prepare(State& state);

  /// `n_steps` steps of dt [s] without pads (the rail is lifted).
  /// Throws proto::Error (numerics) naming step, time and body when the motion is no longer finite; the state is then
  /// of no use.
  void advance(State& state, double dt, std::int64_t n_steps);

  /// The same with the rail foot driven. The pad forces of the state's own time level are brought to the new rail
  /// velocity before the first step, except while relaxing.
  PadSums advance(State& state, double dt, std::int64_t n_steps, const PadDrive& drive);

  /// Opens the energy ledger at `state`, whose contacts are those of the last step or prepare(): from now on work and
  /// dissipation are counted in the steps, by trapezoids as the integrator's own. Forces of moving planes, of
  /// pad_body_load and of artificial damping are not in it. A device counts no flows: its steps leave the ledger
  /// closed.
  void open_ledger(State& state) const;
  /// The ledger at `state`, the one of the last step.
  EnergyBalance balance(const State& state) const;
  /// What the viscosity of all elements dissipates now [W].
  double viscous_power(const State& state) const;

  StoredEnergy stored(const State& state) const;  ///< at the last step's contacts
  Energies energies(const State& state) const;
  double kinetic_energy(const State& state) const;  ///< alone, which is cheaper [J]
  /// Largest speed of any particle [m/s].
  double largest_speed(const State& state) const;
  /// Sum over bodies of |resultant force| over the sum of |contact force| on particles, at the last step's contact
  /// forces; what a fixity holds does not count. 0 for perfect rest, 1 for free fall (no contact).
  double unbalanced_ratio(const State& state) const;

  /// Displacement (from `reference`, positions laid out like state.x) and velocity of the sleeper at the pad cells, in
  /// seat axes, in order of cell, axis [m], [m/s].
  std::vector<double> pad_displacement(const State& state, const std::vector<double>& reference) const;
  std::vector<double> pad_velocity(const State& state) const;

  /// Positions from which the pads measure the sleeper's displacement; set before the first driven advance. Laid out
  /// like state.x.
  void set_pad_reference(const std::vector<double>& reference);

  const ContactStage& contacts() const;

 private:
  void book_viscosity(State& state) const;

  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace qdem
