#include "coupler/scheme/iterated.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "proto/error.hpp"

namespace coupler {

IteratedScheme::IteratedScheme(SchemeSetup setup, const proto::Iteration& settings)
    : CouplingScheme(std::move(setup)), settings_(settings), acceleration_(make_acceleration(settings)) {}

void IteratedScheme::pass(WindowRecord& record, std::uint32_t iteration, std::vector<double> force, Sides sides) {
  solve_rail(record, force_request(record, iteration, std::move(force)), sides.implicit_side);
  solve_sleeper(record, path_request(record, iteration), sides.explicit_side);
}

std::vector<double> IteratedScheme::mean_force(const WindowRecord& record) const {
  std::vector<double> force = record.impulse;
  for (auto& value : force) value /= window_s();
  return force;
}

void IteratedScheme::solve(WindowRecord& record, Sides sides) {
  if (record.phase != proto::Phase::march) {
    pass(record, 0, state_.force_mean, sides);
    return;
  }
  auto force = extrapolated_force(state_);
  std::vector<double> rail_before;
  double residual_before = 0.0;
  for (std::uint32_t k = 0;; ++k) {
    if (k > 0) roll_back(record, sides);
    pass(record, k, force, sides);
    const auto image = mean_force(record);
    const double residual = norm(residual_of(force, image)), scale = std::max(state_.force_scale, norm(image));
    record.solves = static_cast<int>(k) + 1;
    record.force_residual = scale > 0.0 ? residual / scale : 0.0;
    if (residual_before > 0.0) record.contraction = residual / residual_before;
    const bool converged = has_converged(record, rail_before);
    if (!converged && record.solves == settings_.max_iterations) give_up(record);
    if (converged || !record.converged) {
      acceleration_->end_window(state_.acceleration, force, image);
      return;
    }
    force = acceleration_->next(state_.acceleration, force, image);
    rail_before = record.rail_displacement;
    residual_before = residual;
  }
}

bool IteratedScheme::has_converged(const WindowRecord& record, const std::vector<double>& rail_before) const {
  if (record.force_residual > settings_.force_tolerance) return false;
  if (rail_before.empty()) return record.force_residual == 0.0;
  const double scale = std::max(state_.displacement_scale, norm(record.rail_displacement));
  return norm(residual_of(rail_before, record.rail_displacement)) <= settings_.displacement_tolerance * scale;
}

void IteratedScheme::give_up(WindowRecord& record) const {
  record.converged = false;
  if (settings_.accept_at_limit) return;
  throw proto::Error(
      proto::ExitCode::numerics,
      fmt::format("the iteration did not converge in {} passes: residual of the mean force {:.2e} "
                  "(force_tolerance {:.2e}), last contraction {:.2g}",
                  record.solves, record.force_residual, settings_.force_tolerance, record.contraction),
      fmt::format("window {}", record.window),
      "shorten coupling.window_s, raise coupling.iteration.max_iterations, or set at_limit = \"accept\"");
}

}  // namespace coupler
