// The contact patch without friction: Hertz's ellipses (physics.md 3.1), Cattaneo's ball (K1 of 3.2), orders.
#include <cmath>
#include <cstdio>
#include <limits>

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

// The approach of a ball against Hertz's closed form.
TEST(Order, of_the_approach_is_two) {
  const double force = 80e3, radius = 0.25, modulus = 210e9 / (2 * (1 - 0.09));
  const double a = std::cbrt(3 * force * radius / (4 * modulus));
  const Figures exact{a, a, 3 * force / (2 * M_PI * a * a), a * a / radius};
  std::vector<double> steps, errors;
  for (const int n : {6, 9, 13, 19, 28}) {
    const Figures found = solved({1 / radius, 1 / radius, {}, 0.0}, {210e9, 0.3}, force, exact, n);
    steps.push_back(1.0 / n);
    errors.push_back(std::abs(found.approach / exact.approach - 1));
  }
  std::printf("order %.2f\n", tests::fitted_order(steps, errors));
  EXPECT_TRUE(tests::converges_with_order(steps, errors, 2.0, 0.3));
}

// The stiffness that Newton uses is the derivative of the force: 1.5 F/delta where Hertz holds.
TEST(Tangent, is_that_of_hertz_and_of_a_difference) {
  const fem::PatchGrid grid = grid_for({6.433e-3, 5.061e-3, 0, 0}, 12);
  const fem::NormalPatch patch(grid, fem::pair_elasticity({210e9, 0.3}, {210e9, 0.3}));
  const auto gap = fem::contact_gap({1 / .43, 1 / .30, {}, 0.0}, grid).height;
  const auto at = [&](double approach) { return patch.at_approach(gap, approach, grid.zeros(), "test"); };
  const auto found = at(90.8e-6);
  EXPECT_TRUE(near_rel(found.tangent, 1.321e9, 0.03));
  // A difference so small that no element changes its side.
  EXPECT_TRUE(near_rel((at(90.8e-6 + 1e-12).force - at(90.8e-6 - 1e-12).force) / 2e-12, found.tangent, 1e-5));
}

// Far from an element its traction acts as the point force of Boussinesq and Cerruti (Johnson 3.22, 3.76).
TEST(Influence, of_a_far_element_is_that_of_a_point) {
  const fem::PatchGrid grid{16, 16, 1e-3, 1e-3};
  const fem::PairElasticity pair{80e9, 0.3, 0.0};
  const fem::PatchBox all{0, 0, 16, 16};
  fem::PatchField traction = grid.zeros();
  traction(1, 2) = 1e9;
  const double shift = 0.7e-3, x = grid.x(13) + shift - grid.x(1), y = grid.y(9) - grid.y(2), r = std::hypot(x, y);
  const double scale = 1e9 * grid.area() / (M_PI * pair.shear_modulus);
  const auto displacement = [&](fem::Influence influence) {
    fem::PatchField u = grid.zeros();
    fem::InfluenceTable(grid, pair, influence, shift).add(all, traction, u);
    return u(13, 9);
  };
  EXPECT_TRUE(near_rel(displacement(fem::Influence::normal), scale * 0.7 / r, 2e-3));
  EXPECT_TRUE(near_rel(displacement(fem::Influence::xx), scale * (0.7 / r + 0.3 * x * x / (r * r * r)), 2e-3));
  EXPECT_TRUE(near_rel(displacement(fem::Influence::yy), scale * (0.7 / r + 0.3 * y * y / (r * r * r)), 2e-3));
  EXPECT_TRUE(near_rel(displacement(fem::Influence::xy), scale * 0.3 * x * y / (r * r * r), 4e-3));
}

// Two parabolas given as tables of points touch as their curvatures do.
TEST(Profiles, parabolas_are_hertz) {
  std::vector<double> y, wheel, rail;
  for (int k = -30; k <= 30; ++k) {
    y.push_back(1e-3 * k);
    wheel.push_back(y.back() * y.back() / 2);              // 1 m, hollow outwards
    rail.push_back(-y.back() * y.back() / 2 * (7.0 / 3));  // together 0.3 m
  }
  const fem::PatchGrid grid = grid_for({6.433e-3, 5.061e-3, 0, 0}, 12);
  const fem::ContactGeometry tables{1 / .43, 0.0, {{y, wheel}, {y, rail}}, 0.002};
  const auto gap = fem::contact_gap(tables, grid);
  // The shift of 2 mm moves the point of contact to y/R_wheel + ... = 0: (y - s)/1 + 7/3 y = 0.
  EXPECT_TRUE(tests::near_abs(gap.centre_y, 0.002 * 0.3, 1e-6));
  const fem::NormalPatch patch(grid, fem::pair_elasticity({210e9, 0.3}, {210e9, 0.3}));
  const auto found = patch.at_force(gap.height, 80e3, {grid.zeros(), 50e-6}, "test");
  EXPECT_TRUE(near_rel(found.approach, 90.8e-6, 0.01));
}

TEST(Profiles, too_short_or_too_wide_are_refused) {
  const fem::SurfaceProfile short_one({-1e-3, 0.0, 1e-3}, {0.0, 0.0, 0.0});
  const fem::PatchGrid grid{10, 10, 1e-3, 1e-3};
  EXPECT_THROW(fem::contact_gap({2.0, 0.0, {short_one, short_one}, 0.0}, grid), proto::Error);
  EXPECT_THROW(fem::SurfaceProfile({-35.0, 0.0, 35.0}, {0.0, 0.0, 0.0}), proto::Error);
}

TEST(Refused, a_patch_at_the_edge_and_unlike_materials) {
  const fem::PatchGrid grid{10, 10, 0.5e-3, 0.5e-3};
  const fem::NormalPatch patch(grid, fem::pair_elasticity({210e9, 0.3}, {210e9, 0.3}));
  const auto gap = fem::contact_gap({1 / .43, 1 / .30, {}, 0.0}, grid).height;
  try {
    fem::require_inside(patch.at_force(gap, 80e3, {grid.zeros(), 50e-6}, "test").pressure, "window 7");
    FAIL() << "no error";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    EXPECT_NE(std::string(error.what()).find("edge of its grid"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("window 7"), std::string::npos);
  }
  EXPECT_THROW(fem::pair_elasticity({210e9, 0.3}, {5e6, 0.3}), proto::Error);
  EXPECT_NO_THROW(fem::pair_elasticity({210e9, 0.3}, {200e9, 0.28}));
}

// What is not a number ends with the residuals.
TEST(Refused, no_convergence_tells_the_residuals) {
  const fem::PatchGrid grid{10, 10, 0.5e-3, 0.5e-3};
  const fem::NormalPatch patch(grid, fem::pair_elasticity({210e9, 0.3}, {210e9, 0.3}));
  fem::PatchField gap = fem::contact_gap({1 / .43, 1 / .30, {}, 0.0}, grid).height;
  gap(5, 5) = -std::numeric_limits<double>::infinity();
  try {
    patch.at_approach(gap, 1e-5, grid.zeros(), "window 7");
    FAIL() << "no error";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    EXPECT_NE(std::string(error.what()).find("over the overlap ("), std::string::npos) << error.what();
  }
  EXPECT_THROW(patch.at_approach(gap, std::nan(""), grid.zeros(), "window 7"), proto::Error);
}

}  // namespace
