#include "fem_solver/contact/patch_contact.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "fem_solver/contact/contact_analysis.hpp"
#include "fem_solver/contact/hertz_contact.hpp"
#include "fem_solver/contact/patch_ellipse.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

PatchGrid grid_of(const WheelSettings& wheel) {
  const PatchEllipse ellipse =
      hertz_ellipse(wheel.radius, wheel.rail_crown_radius, wheel.wheel, wheel.rail, wheel.static_load);
  return grid_around(ellipse, wheel.patch->elements_per_semi_axis, wheel.patch->grid_margin);
}

}  // namespace

PatchContact::PatchContact(const WheelSettings& wheel, double step)
    : wheel_(wheel),
      settings_(*wheel.patch),
      step_(step),
      pair_(pair_elasticity(wheel.wheel, wheel.rail)),
      grid_(grid_of(wheel)),
      gap_(contact_gap(settings_.geometry, grid_).height),
      normal_(grid_, pair_),
      rolling_(grid_, pair_) {
  double approach = 0.0;
  const PatchState rest = at_rest(wheel.start, approach);
  const double semi_axis = fit_ellipse(grid_, rest.pressure).semi_axis_x;
  if (wheel.speed * step > semi_axis)
    throw proto::Error(
        proto::ExitCode::config,
        "the wheel travels " + std::to_string(wheel.speed * step * 1e3) +
            " mm in a window, more than the contact patch's semi-axis of " + std::to_string(semi_axis * 1e3) + " mm",
        "coupling.window_s, wheel.speed_m_per_s", "shorten the window or take wheel.contact = \"hertz\"");
}

std::string PatchContact::where(double position) const {
  return "fem: contact patch at x = " + std::to_string(position) + " m";
}

PatchField PatchContact::gap_at(double position) const {
  PatchField gap = gap_;
  const Irregularity& rail = wheel_.irregularity;
  if (rail.kind == IrregularityKind::none) return gap;
  const double here = rail.height_at(position);
  for (int i = 0; i < grid_.n_x; ++i) gap.row(i) += here - rail.height_at(position + grid_.x(i));
  return gap;
}

PatchState PatchContact::at_rest(double position, double& approach) const {
  const NormalSolution normal = normal_.at_force(
      gap_at(position), wheel_.static_load, first_guess(grid_, pair_, wheel_.static_load), where(position).c_str());
  require_inside(normal.pressure, where(position).c_str());
  approach = normal.approach;
  return {normal.pressure, PatchVectors::zeros(grid_), PatchVectors::zeros(grid_),
          -settings_.creepage.longitudinal * wheel_.speed};
}

ContactLaw PatchContact::law(double position, const PatchState& state) const {
  return [this, place = where(position), gap = gap_at(position),
          guess = state.pressure](double approach) mutable -> ContactForce {
    const NormalSolution now = normal_.at_approach(gap, approach, guess, place.c_str());
    guess = now.pressure;
    return {now.force, now.tangent};
  };
}

Creepage PatchContact::creepage(const PatchState& state) const {
  Creepage now = settings_.creepage;
  if (settings_.drive && wheel_.speed > 0) now.longitudinal = -state.running_ahead / wheel_.speed;
  return now;
}

void PatchContact::roll(double position, double approach, PatchState& state) {
  const std::string place = where(position);
  const PatchField pressure = normal_.at_approach(gap_at(position), approach, state.pressure, place.c_str()).pressure;
  require_inside(pressure, place.c_str());
  const double travel = wheel_.speed * step_;
  const int n = static_cast<int>(std::ceil(travel / grid_.dx));
  for (int k = 1; k <= n; ++k) {
    const double part = static_cast<double>(k) / n;
    const PatchField bound = settings_.friction * ((1 - part) * state.pressure + part * pressure);
    TangentialSolution now = rolling_.step(bound, state.traction, creepage(state), travel / n, place.c_str());
    state.traction = std::move(now.traction);
    state.slip = {now.slip.x * (n / travel), now.slip.y * (n / travel)};
    if (!settings_.drive) continue;
    const double pull = resultant(grid_, state.traction).longitudinal;
    state.running_ahead +=
        step_ / n * wheel_.radius / settings_.drive->polar_inertia * (settings_.drive->torque - wheel_.radius * pull);
  }
  state.pressure = pressure;
}

std::unique_ptr<WheelContact> make_wheel_contact(const WheelSettings& wheel, double step) {
  if (wheel.patch) return std::make_unique<PatchContact>(wheel, step);
  const Hertz hertz(wheel.radius, wheel.rail_crown_radius, wheel.wheel, wheel.rail);
  return std::make_unique<HertzContact>(hertz, wheel.static_load);
}

}  // namespace fem
