// The wheel's contact as a resolved patch.
#pragma once

#include "fem_solver/contact/normal_patch.hpp"
#include "fem_solver/contact/wheel_contact.hpp"
#include "fem_solver/model/settings.hpp"

namespace fem {

/// The local compliance of wheel and rail is that of half-spaces, the same wherever the contact stands; the grid moves
/// with the wheel. The whole patch sees the rail's irregularity. Normal force: NormalPatch with its consistent tangent.
/// Friction: RollingPatch in sub-steps of at most an element, the pressure running linearly from window to window, the
/// wheel's rotation prescribed or integrated under its torque (semi-implicit Euler).
class PatchContact : public WheelContact {
 public:
  /// `step`: window [s]. Throws proto::Error: config for a travel above the patch's semi-axis in a window; bad_data,
  /// numerics.
  PatchContact(const WheelSettings& wheel, double step);

  PatchState at_rest(double position, double& approach) const override;
  ContactLaw law(double position, const PatchState& state) const override;
  void roll(double position, double approach, PatchState& state) override;

  const PatchGrid& grid() const { return grid_; }
  const PatchSettings& settings() const { return settings_; }
  /// Creepage of the wheel as it turns now.
  Creepage creepage(const PatchState& state) const;
  /// Per element, along the rail first.
  std::vector<Zone> zones(const PatchState& state) const {
    return fem::zones(settings_.friction * state.pressure, state.traction);
  }

 private:
  PatchField gap_at(double position) const;
  std::string where(double position) const;

  WheelSettings wheel_;
  PatchSettings settings_;
  double step_;
  PairElasticity pair_;
  PatchGrid grid_;
  PatchField gap_;  // of wheel and even rail
  NormalPatch normal_;
  RollingPatch rolling_;
};

/// The contact that the case asks for.
std::unique_ptr<WheelContact> make_wheel_contact(const WheelSettings& wheel, double step);

}  // namespace fem
