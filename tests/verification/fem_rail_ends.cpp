// What comes back from the rail's ends: a bending pulse runs out of the refined part, and the same pulse on a rail so
// long that nothing returns is subtracted.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fem_solver/time/newmark.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/fem_rails.hpp"
#include "tests/support/timoshenko_waves.hpp"
#include "tests/support/tolerance.hpp"

namespace {

constexpr double step = 5e-5, duration = 5e-3, pulse = 1e-3, seen_at = 1.6;  // [s], [m]

fem::FemSettings short_rail() {
  auto s = tests::small_track();
  s.n_bays = 6;
  s.loss_factor = 0.0;
  s.end_dashpot_frequency = 0.0;
  return s;
}

// Vertical velocity of the running band at `seen_at` after a raised-cosine force of 1 ms at x = 0.
std::vector<double> velocity(const fem::RailBuilder& build, const fem::FemSettings& settings) {
  const auto rail = build(settings, {tests::rail_seat(0.0)}, fem::SeatOwner::own_supports);
  const auto& band = rail->band();
  const fem::Newmark newmark(rail->track(), step, 0.0);
  auto state = newmark.state_at_rest(Eigen::VectorXd::Zero(rail->track().n_dofs()));
  std::vector<double> history;
  for (double t = step / 2; t < duration; t += step) {
    Eigen::VectorXd load = Eigen::VectorXd::Zero(rail->track().n_dofs());
    if (t < pulse) band.add_load(band.at(0.0), 1e3 * (1 - std::cos(tests::two_pi * t / pulse)), load);
    const Eigen::VectorXd right_side = newmark.right_side(state, load);
    newmark.finish(state, newmark.response(right_side), right_side);
    history.push_back(band.read(band.at(seen_at), state.velocity));
  }
  return history;
}

// Dispersion spreads the pulse on its way: its size is the root of the mean square, which that does not change.
double size_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum);
}

class Ends : public tests::BothRails {
 protected:
  // Size of the reflected velocity over that of the pulse that runs out.
  double reflected(const fem::FemSettings& settings) {
    auto difference = velocity(GetParam().build, settings);
    for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= endless()[i];
    return size_of(difference) / size_of(endless());
  }

  // Half a length of 9 m: what its free ends throw back needs more than the duration.
  const std::vector<double>& endless() {
    if (endless_.empty()) {
      auto s = short_rail();
      s.n_bays = 30;
      endless_ = velocity(GetParam().build, s);
    }
    return endless_;
  }

 private:
  std::vector<double> endless_;
};

TEST_P(Ends, absorb_a_bending_pulse) {
  auto settings = short_rail();
  const double free_end = reflected(settings);
  settings.end_dashpot_frequency = 500.0;
  const double dashpots = reflected(settings);
  settings.end_layer_bays = 10;
  const double layer = reflected(settings);
  std::printf("%s: free end %.1f %%, dashpots %.1f %%, dashpots and layer %.2f %%\n", GetParam().name, 100 * free_end,
              100 * dashpots, 100 * layer);
  EXPECT_TRUE(tests::near_abs(free_end, 1.0, 0.25));
  EXPECT_TRUE(tests::near_abs(layer, 0.0, 0.02));
}

INSTANTIATE_TEST_SUITE_P(rails, Ends, tests::BothRails::kinds(), tests::BothRails::name);

}  // namespace
