#include "coupler/advisor/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupler/advisor/stability.hpp"

namespace coupler {
namespace {

using proto::Scheme;

constexpr Scheme explicit_schemes[] = {Scheme::parallel_staggered, Scheme::serial_staggered,
                                       Scheme::serial_extrapolated, Scheme::robin_explicit, Scheme::robin_corrected};
constexpr const char* axis_names[] = {"longitudinal", "lateral", "normal"};

bool is_explicit(Scheme scheme) {
  return std::find(std::begin(explicit_schemes), std::end(explicit_schemes), scheme) != std::end(explicit_schemes);
}

std::string window_text(double window_s) {
  return std::isfinite(window_s) ? window_s > 0.0 ? fmt::format("{:.2e} s", window_s) : "none" : "any";
}

/// Of one axis, in the case's windows.
void judge(Advice& advice, const proto::Coupling& coupling, const SeatAxis& axis) {
  const StabilityScan scan;
  if (proto::uses_robin(coupling.scheme) && axis.track.pad.stiffness > 0.0 && axis.track.pad.damping == 0.0)
    advice.warnings.push_back(fmt::format("{}: the pad has no damping; {} is stable for damped pads only", axis.name,
                                          proto::name_of(coupling.scheme)));
  if (!is_explicit(coupling.scheme) || !advice.refusal.empty()) return;
  const double growth = growth_per_window(coupling.scheme, coupling, axis.track, coupling.window_s, scan.n_windows);
  if (growth > 1.0 + scan.growth)
    advice.refusal = fmt::format(
        "scheme {} is not stable with windows of {:g} s: on {}, lumped, it grows by a factor of {:.4g} a window "
        "(critical window: {})",
        proto::name_of(coupling.scheme), coupling.window_s, axis.name, growth,
        window_text(critical_window(coupling.scheme, coupling, axis.track)));
}

std::string table(const proto::Coupling& coupling, const SeatAxis& axis) {
  const double h = coupling.window_s, m = axis.track.rail_mass;
  std::string text = fmt::format(
      "advisor, {} (k {:g} N/m, c {:g} N s/m, rail {:g} kg, sleeper {:g} kg), window {:g} s:\n"
      "  fixed-point factor {:.3g}: a plain iteration {} (critical window {})\n",
      axis.name, axis.track.pad.stiffness, axis.track.pad.damping, m, axis.track.sleeper_mass, h,
      fixed_point_factor(axis.track, h), fixed_point_factor(axis.track, h) < 1 ? "contracts" : "diverges",
      window_text(fixed_point_window(axis.track)));
  text += fmt::format("  lag of E0 and E1 outweighs the dashpot beyond {}\n", window_text(lag_window(axis.track)));
  text += "  critical windows on the lumped seat:";
  for (const Scheme scheme : explicit_schemes)
    text += fmt::format("  {} {}", proto::name_of(scheme), window_text(critical_window(scheme, coupling, axis.track)));
  return text;
}

}  // namespace

std::vector<SeatAxis> lumped_seats(const std::vector<proto::RailSeat>& seats, const std::vector<proto::PadLaw>& laws,
                                   double rail_mass, double sleeper_mass) {
  std::vector<SeatAxis> axes;
  std::size_t first = 0;
  for (const auto& seat : seats) {
    const std::size_t n = 3 * static_cast<std::size_t>(seat.n_cells());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      LumpedTrack track;
      track.rail_mass = rail_mass, track.sleeper_mass = sleeper_mass;
      for (std::size_t i = first + axis; i < first + n; i += 3) {
        track.pad.stiffness += laws[i].stiffness;
        track.pad.damping += laws[i].damping;
      }
      if (track.pad.stiffness > 0.0) axes.push_back({fmt::format("seat '{}', {}", seat.name, axis_names[axis]), track});
    }
    first += n;
  }
  return axes;
}

Advice advise(const proto::Coupling& coupling, const std::vector<SeatAxis>& axes) {
  Advice advice;
  if (axes.empty() || proto::is_rigid(coupling.scheme)) return advice;
  for (const auto& axis : axes) judge(advice, coupling, axis);
  advice.text = table(coupling, *std::max_element(axes.begin(), axes.end(), [](const auto& a, const auto& b) {
                        return a.track.pad.stiffness < b.track.pad.stiffness;
                      }));
  return advice;
}

}  // namespace coupler
