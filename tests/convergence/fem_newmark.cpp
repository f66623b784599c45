// Order in time of the window equation: rail, dashpots and pads under a smooth pulse on the head.
#include <cmath>

#include "fem_solver/time/newmark.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/fem_rails.hpp"
#include "tests/support/tolerance.hpp"

namespace {

constexpr double duration = 4e-3;  // [s]

Eigen::VectorXd after_pulse(const fem::RailModel& rail, double step) {
  const auto& system = rail.track();
  const auto& band = rail.band();
  const fem::Newmark newmark(system, step, 0.0);
  auto state = newmark.state_at_rest(Eigen::VectorXd::Zero(system.n_dofs()));
  const long n_steps = std::lround(duration / step);
  for (long n = 0; n < n_steps; ++n) {
    const double s = std::sin(3.14159265358979323846 * (n + 0.5) * step / duration);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(system.n_dofs());
    band.add_load(band.at(0.1), -80e3 * s * s * s * s, load);
    const Eigen::VectorXd right_side = newmark.right_side(state, load);
    newmark.finish(state, newmark.response(right_side), right_side);
  }
  Eigen::VectorXd result(2 * state.displacement.size());
  result << state.displacement, state.velocity * duration;
  return result;
}

using Newmark = tests::BothRails;

TEST_P(Newmark, second_order_in_time) {
  auto settings = tests::small_track();
  settings.n_bays = 6, settings.element_length = 0.3;
  const auto rail = GetParam().build(settings, {tests::rail_seat(0.0)}, fem::SeatOwner::own_supports);
  const Eigen::VectorXd reference = after_pulse(*rail, 5e-6);
  const std::vector<double> steps{1e-4, 5e-5, 2.5e-5};
  std::vector<double> errors;
  for (const double step : steps) errors.push_back((after_pulse(*rail, step) - reference).norm());
  EXPECT_TRUE(tests::converges_with_order(steps, errors, 2.0, 0.1));
}

INSTANTIATE_TEST_SUITE_P(rails, Newmark, tests::BothRails::kinds(), tests::BothRails::name);

}  // namespace
