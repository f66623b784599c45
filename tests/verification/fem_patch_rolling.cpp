// The contact patch with friction: Cattaneo's shift (K2 of physics.md 3.2), Carter's long roller (K3), Kalker's linear
// creep coefficients (3.3), creep-force curves, and the transient after a change of creepage.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fem_solver/contact/contact_gap.hpp"
#include "fem_solver/contact/normal_patch.hpp"
#include "fem_solver/contact/patch_ellipse.hpp"
#include "fem_solver/contact/rolling.hpp"
#include "proto/error.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_abs;
using tests::near_rel;

/// A pressed pair on its grid.
struct Pressed {
  fem::PatchGrid grid;
  fem::PairElasticity pair;
  fem::PatchField pressure;
};

Pressed press(const fem::PatchGrid& grid, const fem::ContactGeometry& geometry, const fem::ElasticBody& body,
              double force, double approach) {
  const auto pair = fem::pair_elasticity(body, body);
  const auto gap = fem::contact_gap(geometry, grid);
  return {grid, pair,
          fem::NormalPatch(grid, pair).at_force(gap.height, force, {grid.zeros(), approach}, "test").pressure};
}

int count(const std::vector<fem::Zone>& zones, fem::Zone zone) {
  return static_cast<int>(std::count(zones.begin(), zones.end(), zone));
}

// Ball of K1, mu = 0.4, pulled by 7/8 of mu F: stick circle of half the radius, shift 8.17 um.
TEST(K2, cattaneo_shift_within_5_percent) {
  const double mu = 0.4, force = 9.1954;
  const fem::PatchGrid grid{36, 36, 1e-3 / 14, 1e-3 / 14};
  const auto ball = press(grid, {20.0, 20.0, {}, 0.0}, {2 * 200e6 * 1.42, 0.42}, force, 10e-6);
  fem::RollingPatch patch(grid, ball.pair);
  const double shift = -8.17e-6;  // the wheel slides back, its traction points forward
  const auto found = patch.shifted(mu * ball.pressure, shift, 0.0, "test");
  const auto zones = fem::zones(mu * ball.pressure, found.traction);
  const int stick = count(zones, fem::Zone::stick), slip = count(zones, fem::Zone::slip);
  const double pull = fem::resultant(grid, found.traction).longitudinal / (mu * force);
  const double radius = std::sqrt(stick * grid.area() / M_PI);
  std::printf("K2: pull %.4f mu F (0.875), stick radius %.4f mm (0.5), %d stick, %d slip, %d products\n", pull,
              radius * 1e3, stick, slip, found.iterations);
  EXPECT_TRUE(near_rel(pull, 0.875, 0.05));
  EXPECT_TRUE(near_rel(radius, 0.5e-3, 0.05));
}

// Roller of 0.5 m, G = 82 GPa, nu = 0.28, 178.90 N/mm, mu = 0.3, creepage -2.4e-4: a = 1 mm, p0 = 113.9 MPa, 60 % of
// the patch sticks and the force is 0.64 mu F. One row of elements, as long as a metre: plane strain.
struct Carter {
  double half_width, peak, stick, pull;
};

Carter carter(int n) {
  const double mu = 0.3, force = 178.90e3;
  const fem::PatchGrid grid{2 * n + 2 * (n / 4), 1, 1e-3 / n, 1.0};
  const auto roller = press(grid, {2.0, 0.0, {}, 0.0}, {2 * 82e9 * 1.28, 0.28}, force, 1e-5);
  fem::RollingPatch patch(grid, roller.pair);
  const fem::PatchField bound = mu * roller.pressure;
  const auto found = patch.steady(bound, fem::PatchVectors::zeros(grid), {-2.4e-4, 0.0, 0.0}, "test");
  const auto zones = fem::zones(bound, found.traction);
  const double stick = count(zones, fem::Zone::stick), slip = count(zones, fem::Zone::slip);
  const auto ellipse = fem::fit_ellipse(grid, roller.pressure);
  const Carter result{ellipse.semi_axis_x, ellipse.peak_pressure, stick / (stick + slip),
                      fem::resultant(grid, found.traction).longitudinal / (mu * force)};
  std::printf(
      "K3, %d elements a half-width: a %.4f mm (1), p0 %.2f MPa (113.9), stick %.3f (0.6), force %.4f mu F (0.64), %d "
      "products\n",
      n, result.half_width * 1e3, result.peak * 1e-6, result.stick, result.pull, found.iterations);
  return result;
}

TEST(K3, carter_within_5_percent) {
  const Carter found = carter(25);
  EXPECT_TRUE(near_rel(found.half_width, 1e-3, 0.05));
  EXPECT_TRUE(near_rel(found.peak, 113.9e6, 0.05));
  EXPECT_TRUE(near_rel(found.stick, 0.6, 0.05));
  EXPECT_TRUE(near_rel(found.pull, 0.64, 0.05));
}

TEST(K3, order_of_the_force_is_one) {
  std::vector<double> steps, errors;
  for (const int n : {8, 16, 32, 48}) {
    steps.push_back(1.0 / n);
    errors.push_back(std::abs(carter(n).pull - 0.64));
  }
  std::printf("order %.2f\n", tests::fitted_order(steps, errors));
  EXPECT_TRUE(tests::converges_with_order(steps, errors, 1.0, 0.2));
}

// Linear creep coefficients for nu = 0.25 (Kalker 1967, 1990; table 3.3): F_x = -C11 G a b xi, F_y = -C22 G a b eta -
// C23 G (a b)^1.5 phi, at a creepage that uses 1 % of the friction.
struct KalkerRow {
  double ratio, c11, c22, c23;  // a/b, a along the rail
};
class Kalker : public ::testing::TestWithParam<KalkerRow> {};

TEST_P(Kalker, within_8_percent) {
  const KalkerRow& row = GetParam();
  const int n = 12;
  const double b = 5e-3, a = row.ratio * b, mu = 0.3, shear = 82e9;
  const fem::PatchGrid grid{2 * n + 2, 2 * n + 2, a / n, b / n};
  // Hertz's pressure itself: the table is for a given ellipse.
  fem::PatchField pressure = grid.zeros();
  for (int j = 0; j < grid.n_y; ++j)
    for (int i = 0; i < grid.n_x; ++i)
      pressure(i, j) = 1e9 * std::sqrt(std::max(0.0, 1 - std::pow(grid.x(i) / a, 2) - std::pow(grid.y(j) / b, 2)));
  fem::RollingPatch patch(grid, fem::pair_elasticity({2 * shear * 1.25, 0.25}, {2 * shear * 1.25, 0.25}));
  const double force = pressure.sum() * grid.area();
  const double small = 0.01 * mu * force / (shear * a * b);
  const auto resultant = [&](const fem::Creepage& creepage) {
    const auto found = patch.steady(mu * pressure, fem::PatchVectors::zeros(grid), creepage, "test");
    return fem::resultant(grid, found.traction);
  };
  const double c11 = -resultant({small / row.c11, 0, 0}).longitudinal / (shear * a * b * small / row.c11);
  const double c22 = -resultant({0, small / row.c22, 0}).lateral / (shear * a * b * small / row.c22);
  const double spin = small / row.c23 / std::sqrt(a * b);
  const double c23 = -resultant({0, 0, spin}).lateral / (shear * std::pow(a * b, 1.5) * spin);
  std::printf("a/b = %.2f: C11 %.3f (%.3f, %+.1f %%), C22 %.3f (%.3f, %+.1f %%), C23 %.3f (%.3f, %+.1f %%)\n",
              row.ratio, c11, row.c11, (c11 / row.c11 - 1) * 100, c22, row.c22, (c22 / row.c22 - 1) * 100, c23, row.c23,
              (c23 / row.c23 - 1) * 100);
  EXPECT_TRUE(near_rel(c11, row.c11, 0.08));
  EXPECT_TRUE(near_rel(c22, row.c22, 0.08));
  EXPECT_TRUE(near_rel(c23, row.c23, 0.08));
}
INSTANTIATE_TEST_SUITE_P(table, Kalker,
                         ::testing::Values(KalkerRow{0.5, 3.62, 3.01, 0.929}, KalkerRow{1.0, 4.12, 3.67, 1.47},
                                           KalkerRow{2.0, 5.10, 4.90, 2.62}));

/// Steel wheel of 0.43 m on a crown of 0.3 m under 80 kN, 8 elements to a semi-axis.
Pressed steel_wheel() {
  const fem::PatchGrid grid{22, 22, 6.433e-3 / 8, 5.061e-3 / 8};
  return press(grid, {1 / .43, 1 / .30, {}, 0.0}, {210e9, 0.3}, 80e3, 5e-5);
}

// Creep-force curve: monotone, below mu N, within 0.1 % of it where all slips; zones from stick to slip.
TEST(CreepForce, is_monotone_and_saturates) {
  const Pressed wheel = steel_wheel();
  const fem::PatchField bound = 0.3 * wheel.pressure;
  fem::RollingPatch patch(wheel.grid, wheel.pair);
  const double full = bound.sum() * wheel.grid.area();
  fem::PatchVectors before = fem::PatchVectors::zeros(wheel.grid);
  double last = 0.0;
  int last_stick = 1 << 20;
  for (const double creepage : {2e-4, 5e-4, 1e-3, 2e-3, 4e-3, 1e-2}) {
    const auto found = patch.steady(bound, before, {creepage, 0.0, 0.0}, "test");
    const double pull = -fem::resultant(wheel.grid, found.traction).longitudinal / full;
    const int stick = count(fem::zones(bound, found.traction), fem::Zone::stick);
    std::printf("creepage %.0e: %.4f mu N, %d of %d elements stick\n", creepage, pull, stick,
                static_cast<int>((bound > 0).count()));
    EXPECT_GT(pull, last);
    EXPECT_LE(pull, 1 + 1e-12);
    EXPECT_LE(stick, last_stick);
    before = found.traction, last = pull, last_stick = stick;
  }
  EXPECT_TRUE(near_abs(last, 1.0, 1e-3));
  EXPECT_EQ(last_stick, 0);
}

// Traction points against the slip, and nothing slips that sticks.
TEST(Friction, coulombs_law_holds_in_every_element) {
  const Pressed wheel = steel_wheel();
  const fem::PatchField bound = 0.3 * wheel.pressure;
  fem::RollingPatch patch(wheel.grid, wheel.pair);
  const auto found = patch.steady(bound, fem::PatchVectors::zeros(wheel.grid), {8e-4, -4e-4, 0.3}, "test");
  const auto zones = fem::zones(bound, found.traction);
  const double rigid = 8e-4 * wheel.grid.dx;
  int n_slip = 0;
  for (Eigen::Index k = 0; k < bound.size(); ++k) {
    const double px = found.traction.x(k), py = found.traction.y(k), sx = found.slip.x(k), sy = found.slip.y(k);
    ASSERT_LE(std::hypot(px, py), bound(k) * (1 + 1e-12));
    if (zones[static_cast<std::size_t>(k)] == fem::Zone::stick) {
      ASSERT_LT(std::hypot(sx, sy), 1e-3 * rigid);
    }
    if (zones[static_cast<std::size_t>(k)] != fem::Zone::slip || std::hypot(sx, sy) < 1e-2 * rigid) continue;
    ++n_slip;
    ASSERT_TRUE(near_abs((px * sx + py * sy) / (std::hypot(px, py) * std::hypot(sx, sy)), -1.0, 1e-3));
  }
  EXPECT_GT(n_slip, 50);
}

// Traction moves with the material: after a shift, free rolling carries it out at the trailing edge; the leading part
// is rid of it first.
TEST(Transient, traction_leaves_with_the_material) {
  const Pressed wheel = steel_wheel();
  const fem::PatchField bound = 0.3 * wheel.pressure;
  fem::RollingPatch patch(wheel.grid, wheel.pair);
  fem::PatchVectors traction = patch.shifted(bound, -20e-6, 0.0, "test").traction;
  const double begin = fem::resultant(wheel.grid, traction).longitudinal;
  EXPECT_GT(begin, 0.3 * bound.sum() * wheel.grid.area());
  const auto front_share = [&] { return traction.x.bottomRows(wheel.grid.n_x / 2).sum() / traction.x.sum(); };
  EXPECT_TRUE(near_abs(front_share(), 0.5, 1e-3));
  double last = begin;
  for (int k = 0; k < 40; ++k) {
    traction = patch.step(bound, traction, {}, wheel.grid.dx, "test").traction;
    const double now = fem::resultant(wheel.grid, traction).longitudinal;
    EXPECT_LT(now, last);
    if (k == 7) {
      EXPECT_LT(front_share(), 0.2);
    }
    last = now;
  }
  EXPECT_LT(last, 0.05 * begin);  // two and a half lengths of the patch have been rolled
}

// Whatever it began with, a transient under a constant creepage ends in steady rolling; with shorter steps within what
// the resolution leaves.
TEST(Transient, ends_in_steady_rolling) {
  const Pressed wheel = steel_wheel();
  const fem::PatchField bound = 0.3 * wheel.pressure;
  fem::RollingPatch patch(wheel.grid, wheel.pair);
  const fem::Creepage creepage{-7e-4, 3e-4, 0.0};
  const auto pull = [&](const fem::PatchVectors& traction) {
    return fem::resultant(wheel.grid, traction).longitudinal;
  };
  const double target = pull(patch.steady(bound, fem::PatchVectors::zeros(wheel.grid), creepage, "test").traction);
  const auto after = [&](double travel, int n_steps) {
    fem::PatchVectors traction = patch.shifted(bound, 20e-6, 10e-6, "test").traction;
    for (int k = 0; k < n_steps; ++k) traction = patch.step(bound, traction, creepage, travel, "test").traction;
    return pull(traction);
  };
  EXPECT_FALSE(near_rel(after(wheel.grid.dx, 8), target, 0.05));
  EXPECT_TRUE(near_rel(after(wheel.grid.dx, 80), target, 1e-3));
  EXPECT_TRUE(near_rel(after(0.8 * wheel.grid.dx, 100), target, 0.03));
}

// Contact opens: nothing is left to be carried; it closes: friction begins anew.
TEST(Transient, opens_and_closes) {
  const Pressed wheel = steel_wheel();
  const fem::PatchField bound = 0.3 * wheel.pressure;
  fem::RollingPatch patch(wheel.grid, wheel.pair);
  const auto pressed = patch.steady(bound, fem::PatchVectors::zeros(wheel.grid), {1e-3, 0.0, 0.0}, "test");
  const auto open = patch.step(wheel.grid.zeros(), pressed.traction, {1e-3, 0.0, 0.0}, wheel.grid.dx, "test");
  EXPECT_EQ(open.traction.norm().maxCoeff(), 0.0);
  const auto closed = patch.step(bound, open.traction, {1e-3, 0.0, 0.0}, wheel.grid.dx, "test");
  const auto first = patch.step(bound, fem::PatchVectors::zeros(wheel.grid), {1e-3, 0.0, 0.0}, wheel.grid.dx, "test");
  EXPECT_EQ(fem::resultant(wheel.grid, closed.traction).longitudinal,
            fem::resultant(wheel.grid, first.traction).longitudinal);
}

TEST(Refused, no_convergence_tells_the_changes) {
  const Pressed wheel = steel_wheel();
  fem::RollingPatch patch(wheel.grid, wheel.pair);
  try {
    patch.step(0.3 * wheel.pressure, fem::PatchVectors::zeros(wheel.grid), {std::nan(""), 0.0, 0.0}, wheel.grid.dx,
               "window 7");
    FAIL() << "no error";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    EXPECT_NE(std::string(error.what()).find("changes in Pa:"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("window 7"), std::string::npos);
  }
}

}  // namespace
