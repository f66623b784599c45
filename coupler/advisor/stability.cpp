#include "coupler/advisor/stability.hpp"

#include <algorithm>
#include <cmath>

#include "coupler/scheme/coupling_scheme.hpp"

namespace coupler {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Root of the energy of the two masses, their grounds and the pad.
double size(const LumpedTrack& track, const LumpedRail& rail, const LumpedSleeper& sleeper) {
  const double u = rail.displacement(), v = rail.velocity(), x = sleeper.displacement(), y = sleeper.velocity();
  return std::sqrt(track.rail_mass * v * v + track.sleeper_mass * y * y + track.rail_stiffness * u * u +
                   track.sleeper_stiffness * x * x + track.pad.stiffness * (u - x) * (u - x));
}

double pad_frequency(const LumpedTrack& track) {
  return std::sqrt(track.pad.stiffness * (1 / track.rail_mass + 1 / track.sleeper_mass));
}

}  // namespace

double fixed_point_factor(const LumpedTrack& track, double window_s) {
  return window_s * (track.pad.stiffness * window_s / 4 + track.pad.damping / 2) / track.rail_mass;
}

double fixed_point_window(const LumpedTrack& track) {
  const double k = track.pad.stiffness, c = track.pad.damping;
  return k > 0.0 ? (std::sqrt(c * c + 4 * k * track.rail_mass) - c) / k : 2 * track.rail_mass / c;
}

double lag_window(const LumpedTrack& track) {
  return track.pad.stiffness > 0.0 ? 0.8 * track.pad.damping / track.pad.stiffness : infinite;
}

double growth_per_window(proto::Scheme scheme, const proto::Coupling& coupling, const LumpedTrack& given,
                         double window_s, int n_windows) {
  LumpedTrack track = given;
  track.u = 1.0, track.v = 0.0, track.x = -0.5, track.y = 0.3 * pad_frequency(track);
  LumpedRail rail(track);
  LumpedSleeper sleeper(track);
  // Sub-steps of a tenth of the sleeper's own limit: the question is the coupling's.
  const double step = 0.2 / std::sqrt((track.pad.stiffness + track.sleeper_stiffness) / track.sleeper_mass);
  auto windows = make_scheme(scheme, coupling, {window_s, sub_cycles_for(window_s, step), {track.pad}});
  windows->start({{track.u}, {track.v}, {track.x}, {track.y}});
  double half_way = 0.0;
  for (int n = 0; n < n_windows; ++n) {
    if (n == n_windows / 2) half_way = size(track, rail, sleeper);
    windows->advance(proto::Phase::march, n, {rail, sleeper});
    if (!(size(track, rail, sleeper) < 1e100)) return infinite;
  }
  const double end = size(track, rail, sleeper);
  return half_way > 0.0 ? std::pow(end / half_way, 2.0 / n_windows) : 0.0;
}

double critical_window(proto::Scheme scheme, const proto::Coupling& coupling, const LumpedTrack& track,
                       const StabilityScan& scan) {
  const double unit = 1.0 / pad_frequency(track);
  const auto stable = [&](double window_s) {
    return growth_per_window(scheme, coupling, track, window_s, scan.n_windows) <= 1.0 + scan.growth;
  };
  double low = 0.0, high = scan.shortest * unit;
  while (stable(high)) {
    low = high;
    high *= 1.4;
    if (high > scan.longest * unit) return infinite;
  }
  if (low == 0.0) return 0.0;
  for (int i = 0; i < 6; ++i) {
    const double middle = std::sqrt(low * high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace coupler
