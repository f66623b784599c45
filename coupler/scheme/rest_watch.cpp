#include "coupler/scheme/rest_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace coupler {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Width of the band of one seat's force over its scale.
double relative_band(const std::deque<RestSample>& history, std::size_t seat, double force_floor) {
  const double last = history.back().seat_force[seat];
  double lowest = last, highest = last;
  for (const auto& sample : history) {
    lowest = std::min(lowest, sample.seat_force[seat]);
    highest = std::max(highest, sample.seat_force[seat]);
  }
  const double band = highest - lowest, scale = std::max(std::abs(last), force_floor);
  // A seat that carries nothing at all is at rest; one that swings about nothing is not.
  return band == 0.0 ? 0.0 : scale > 0.0 ? band / scale : infinite;
}

}  // namespace

bool RestWatch::add(RestSample sample) {
  ++n_windows_;
  history_.push_back(std::move(sample));
  // A change over n windows is seen by n + 1 values.
  const auto n_kept = static_cast<std::size_t>(limits_.check_windows) + 1;
  if (history_.size() < n_kept) return false;
  if (history_.size() > n_kept) history_.pop_front();
  figures_ = {0.0, 0.0, 0.0};
  for (std::size_t seat = 0; seat < history_.back().seat_force.size(); ++seat)
    figures_.change = std::max(figures_.change, relative_band(history_, seat, limits_.force_floor));
  for (const auto& past : history_) {
    figures_.qdem_residual = std::max(figures_.qdem_residual, past.qdem_residual);
    figures_.fem_residual = std::max(figures_.fem_residual, past.fem_residual);
  }
  return n_windows_ >= limits_.min_windows && figures_.change <= limits_.tolerance &&
         figures_.qdem_residual <= limits_.qdem_residual_limit && figures_.fem_residual <= limits_.fem_residual_limit;
}

std::string RestWatch::text() const {
  return fmt::format(
      "change of the seat force {:.2e} (tolerance {:.2e}), residual of qdem {:.2e} (qdem_residual_limit {:.2e}), "
      "residual of fem {:.2e} (fem_residual_limit {:.2e})",
      figures_.change, limits_.tolerance, figures_.qdem_residual, limits_.qdem_residual_limit, figures_.fem_residual,
      limits_.fem_residual_limit);
}

}  // namespace coupler
