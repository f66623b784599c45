// Wheel, rail and interface window by window.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "fem_solver/contact/hertz.hpp"
#include "fem_solver/contact/patch_contact.hpp"
#include "fem_solver/model/settings.hpp"
#include "fem_solver/rail/rail_model.hpp"
#include "fem_solver/time/interface_solve.hpp"
#include "fem_solver/time/newmark.hpp"
#include "fem_solver/time/statics.hpp"
#include "fem_solver/wheel/wheel_model.hpp"

namespace fem {

/// What the coupling partner says about the coupled cells for one window. Sizes: coupled values.
struct WindowInput {
  Eigen::VectorXd sleeper_displacement;       ///< x*, window mean [m]
  Eigen::VectorXd sleeper_velocity;           ///< y*, window mean [m/s]
  Eigen::VectorXd carry;                      ///< subtracted from the pad's force [N]
  std::optional<Eigen::VectorXd> prescribed;  ///< force on the sleeper instead of the pad law [N]
};

/// Forces of one window on the sleepers: by the pad law, and as the rail felt their reaction [N].
struct WindowOutput {
  Eigen::VectorXd force_robin, force_used;
};

/// Mutable part of the simulation.
struct RunState {
  TrackState track;
  WheelMotion wheel;              ///< from touching the undeformed rail without load, up
  std::int64_t windows = 0;       ///< since time 0
  InterfaceSolution last;         ///< guess for the next window
  PatchState patch;               ///< of a resolved contact
  std::int64_t windows_open = 0;  ///< for how many windows the wheel has been off the rail
  double wheel_position = 0.0;    ///< x of the contact of the last window's middle, or the start [m]
};

/// A wheel under its static load runs along the rail on its contact. Wheel and rail share one window equation:
/// average acceleration, contact evaluated at mid-window position and mean approach; it may open and does not stick.
class WheelTrack {
 public:
  /// `rail` must outlive it. `laws`: one per coupled value. `step`: window H [s].
  WheelTrack(const RailModel& rail, const FemSettings& fem, const WheelSettings& wheel, WheelModel model, double step,
             std::vector<proto::PadLaw> laws);
  /// With mass_wheel().
  WheelTrack(const RailModel& rail, const FemSettings& fem, const WheelSettings& wheel, double step,
             std::vector<proto::PadLaw> laws)
      : WheelTrack(rail, fem, wheel, mass_wheel(wheel), step, std::move(laws)) {}
  WheelTrack(const WheelTrack&) = delete;
  WheelTrack& operator=(const WheelTrack&) = delete;

  /// Sets the static state with the wheel at its start and the coupled sleepers held at `sleeper_displacement` [m].
  void rest(const Eigen::VectorXd& sleeper_displacement);

  /// One window with the wheel standing at its start under its static load and mass-proportional damping on.
  /// `step`: length of this window, which need not be that of the march [s].
  WindowOutput relax(const WindowInput& input, double step);

  /// How far the last relax() was from static equilibrium: what its window means leave to inertia and damping,
  /// load - K u = M a + C v, over the load of weight, wheel and pads; both as the sum of the sizes of the nodal forces,
  /// which does not depend on how many nodes share a force [-].
  double residual() const { return residual_; }

  /// Damping off, velocities to zero, clock to zero; displacements and forces stay.
  void start();

  /// One window of the march. Throws proto::Error (numerics) when the contact is open for longer than the case allows.
  WindowOutput march(const WindowInput& input);

  const RunState& state() const { return state_; }
  void set_state(const RunState& state) { state_ = state; }
  const WheelModel& wheel_model() const { return wheel_model_; }
  double contact_force() const { return state_.last.contact; }
  double position_at(double window) const { return wheel_.start + wheel_.speed * step_ * window; }
  const Hertz& hertz() const { return hertz_; }
  /// The resolved contact, if the case has one.
  const PatchContact* patch() const { return dynamic_cast<const PatchContact*>(contact_.get()); }
  const Statics& statics() const { return statics_; }
  const RunningBand& band() const { return band_; }
  /// RailModel::indentation() [m/N].
  double indentation() const { return indentation_; }
  double n_factor_entries() const { return march_.newmark.factor().n_factor_entries(); }

  Eigen::VectorXd cell_displacement() const { return system_.cells * state_.track.displacement; }
  Eigen::VectorXd cell_velocity() const { return system_.cells * state_.track.velocity; }

 private:
  // A Newmark operator with what the interface needs of its inverse.
  struct Stepper {
    Stepper(const TrackSystem& system, double step, double mass_damping);
    Newmark newmark;
    Eigen::MatrixXd interface_columns;        // A^-1 Phi'
    Eigen::MatrixXd compliance;               // Phi A^-1 Phi'
    std::map<int, Eigen::VectorXd> stations;  // A^-1 of the station loads around the wheel
  };
  enum class Wheel { standing, rolling };

  WindowOutput advance(Stepper& stepper, const WindowInput& input, Wheel wheel);
  Eigen::VectorXd contact_response(Stepper& stepper, const BandWeights& place) const;
  double excess_flexibility(const BandWeights& place) const { return indentation_ - place.missing_flexibility; }
  void add_wheel(InterfaceProblem& problem, const BandWeights& place, double position, const Eigen::VectorXd& response,
                 const Eigen::VectorXd& free) const;
  void set_rest(const Eigen::VectorXd& displacement);
  void watch_contact_loss(const std::string& where);
  double static_residual(const TrackState& before, const Eigen::VectorXd& force_used) const;

  const TrackSystem& system_;
  WheelSettings wheel_;
  WheelModel wheel_model_;
  WheelStepper wheel_stepper_;
  double step_, initialise_damping_;
  std::vector<proto::PadLaw> laws_;
  const RunningBand& band_;
  Hertz hertz_;
  std::unique_ptr<WheelContact> contact_;
  Statics statics_;
  double indentation_;
  Stepper march_;
  std::unique_ptr<Stepper> relax_;  // built by the first relax(), gone after start()
  RunState state_;
  double residual_ = 0.0;
};

}  // namespace fem
