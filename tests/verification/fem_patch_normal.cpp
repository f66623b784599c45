// The contact patch without friction: Hertz's ellipses (physics.md 3.1), Cattaneo's ball (K1 of 3.2), orders.
#include <cmath>
#include <cstdio>

#include "fem_solver/contact/contact_gap.hpp"
#include "fem_solver/contact/normal_patch.hpp"
#include "fem_solver/contact/patch_ellipse.hpp"
#include "proto/error.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_rel;

/// Published figures of a contact [m, Pa].
struct Figures {
  double a, b, p0, approach;  // along and across the rail
};

/// `n` elements to a semi-axis of the expected ellipse, a margin of a quarter around it.
fem::PatchGrid grid_for(const Figures& expected, int n) {
  const int side = 2 * static_cast<int>(std::ceil(1.25 * n));
  return {side, side, expected.a / n, expected.b / n};
}

Figures solved(const fem::ContactGeometry& geometry, const fem::ElasticBody& body, double force,
               const Figures& expected, int n) {
  const fem::PatchGrid grid = grid_for(expected, n);
  const fem::NormalPatch patch(grid, fem::pair_elasticity(body, body));
  const auto gap = fem::contact_gap(geometry, grid);
  const auto found = patch.at_force(gap.height, force, {grid.zeros(), expected.approach / 2}, "test");
  const auto ellipse = fem::fit_ellipse(grid, found.pressure);
  std::printf("%d elements a semi-axis: a %.4f mm, b %.4f mm, p0 %.4f MPa, approach %.4f um; %d products\n", n,
              ellipse.semi_axis_x * 1e3, ellipse.semi_axis_y * 1e3, ellipse.peak_pressure * 1e-6, found.approach * 1e6,
              found.iterations);
  return {ellipse.semi_axis_x, ellipse.semi_axis_y, ellipse.peak_pressure, found.approach};
}

void expect_near(const Figures& found, const Figures& expected, double tolerance) {
  EXPECT_TRUE(near_rel(found.a, expected.a, tolerance));
  EXPECT_TRUE(near_rel(found.b, expected.b, tolerance));
  EXPECT_TRUE(near_rel(found.p0, expected.p0, tolerance));
  EXPECT_TRUE(near_rel(found.approach, expected.approach, tolerance));
}

struct Row {
  double wheel, crown, force;  // [m], [m], [N]
  Figures hertz;
};
class HertzPatch : public ::testing::TestWithParam<Row> {};

// The table names the longer semi-axis first. The softer curvature is the wheel's along the rail in the first and third
// rows, the crown's across it in the others.
TEST_P(HertzPatch, three_percent_of_physics_3_1) {
  const Row& row = GetParam();
  const Figures found = solved({1 / row.wheel, 1 / row.crown, {}, 0.0}, {210e9, 0.3}, row.force, row.hertz, 16);
  expect_near(found, row.hertz, 0.03);
}
INSTANTIATE_TEST_SUITE_P(rows, HertzPatch,
                         ::testing::Values(Row{.43, .30, 80e3, {6.433e-3, 5.061e-3, 1173e6, 90.8e-6}},
                                           Row{.43, .60, 80e3, {5.733e-3, 7.158e-3, 930.7e6, 80.9e-6}},
                                           Row{.46, .30, 80e3, {6.648e-3, 5.001e-3, 1149e6, 89.7e-6}},
                                           Row{.43, .60, 65e3, {5.350e-3, 6.680e-3, 868e6, 70.5e-6}}));

// G = 200 MPa, nu = 0.42, curvatures 10 1/m, 9.1954 N: a = 1 mm, p0 = 4.3905 MPa, approach 20.00 um.
const fem::ElasticBody cattaneo{2 * 200e6 * 1.42, 0.42};
const Figures cattaneo_ball{1e-3, 1e-3, 4.3905e6, 20e-6};
constexpr double cattaneo_force = 9.1954;

TEST(K1, cattaneo_ball_within_5_percent) {
  expect_near(solved({20.0, 20.0, {}, 0.0}, cattaneo, cattaneo_force, cattaneo_ball, 10), cattaneo_ball, 0.05);
}

// The approach of a ball against Hertz's closed form. The grid's steps along the patch's rim make the error of first
// order there, but the rim carries little: the force is better than that.
TEST(Order, of_the_approach) {
  const fem::ElasticBody body{210e9, 0.3};
  const double force = 80e3, radius = 0.25, modulus = 210e9 / (2 * (1 - 0.09));
  const double a = std::cbrt(3 * force * radius / (4 * modulus));
  const Figures exact{a, a, 3 * force / (2 * M_PI * a * a), a * a / radius};
  std::vector<double> steps, errors;
  for (const int n : {6, 9, 13, 19, 28}) {
    const Figures found = solved({2 / radius / 2, 1 / radius, {}, 0.0}, body, force, exact, n);
    steps.push_back(1.0 / n);
    errors.push_back(std::abs(found.approach / exact.approach - 1));
    std::printf("  error %.3e\n", errors.back());
  }
  std::printf("order %.2f\n", tests::fitted_order(steps, errors));
}

}  // namespace
