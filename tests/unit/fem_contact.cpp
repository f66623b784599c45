// Hertz contact, rail irregularity and the condensed window equations.
#include <cmath>
#include <cstdio>
#include <fstream>

#include "fem_solver/contact/hertz.hpp"
#include "fem_solver/model/irregularity.hpp"
#include "fem_solver/time/interface_solve.hpp"
#include "proto/error.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_abs;
using tests::near_rel;

struct HertzRow {
  double wheel, crown, force;              // [m], [m], [N]
  double semi_long, semi_short, pressure;  // [m], [m], [Pa]
  double approach, stiffness;              // [m], [N/m]
};

class HertzTable : public ::testing::TestWithParam<HertzRow> {};

// physics.md 3.1, steel of 210 GPa and 0.3.
TEST_P(HertzTable, half_percent) {
  const HertzRow row = GetParam();
  const fem::Hertz hertz(row.wheel, row.crown, {}, {});
  const fem::HertzState s = hertz.at_force(row.force);
  EXPECT_TRUE(near_rel(s.semi_axis_long, row.semi_long, 5e-3));
  EXPECT_TRUE(near_rel(s.semi_axis_short, row.semi_short, 5e-3));
  EXPECT_TRUE(near_rel(s.peak_pressure, row.pressure, 5e-3));
  EXPECT_TRUE(near_rel(s.approach, row.approach, 5e-3));
  EXPECT_TRUE(near_rel(s.stiffness, row.stiffness, 5e-3));
  EXPECT_TRUE(near_rel(hertz.coefficient() * std::pow(s.approach, 1.5), row.force, 1e-12));
}
INSTANTIATE_TEST_SUITE_P(physics_3_1, HertzTable,
                         ::testing::Values(HertzRow{.43, .30, 80e3, 6.433e-3, 5.061e-3, 1173e6, 90.8e-6, 1.321e9},
                                           HertzRow{.43, .60, 80e3, 7.158e-3, 5.733e-3, 930.7e6, 80.9e-6, 1.483e9},
                                           HertzRow{.46, .30, 80e3, 6.648e-3, 5.001e-3, 1149e6, 89.7e-6, 1.337e9},
                                           HertzRow{.43, .60, 65e3, 6.680e-3, 5.350e-3, 868e6, 70.5e-6, 1.384e9}));

TEST(Hertz, equal_radii_are_a_sphere_on_a_plane) {
  const fem::Hertz hertz(0.05, 0.05, {60e9, 0.25}, {60e9, 0.25});
  const double modulus = 60e9 / (2 * (1 - 0.25 * 0.25));
  const double radius = std::cbrt(3 * 100.0 * 0.05 / (4 * modulus));
  EXPECT_TRUE(near_rel(hertz.at_force(100.0).semi_axis_long, radius, 1e-6));
  EXPECT_TRUE(near_rel(hertz.at_force(100.0).approach, radius * radius / 0.05, 1e-6));
}

TEST(Hertz, refuses_a_radius_of_zero) {
  EXPECT_THROW(fem::Hertz(0.0, 0.3, {}, {}), proto::Error);
}

TEST(Irregularity, dipped_joint) {
  fem::Irregularity r;
  r.kind = fem::IrregularityKind::dipped_joint;
  r.position = 0.2, r.depth = 1e-3, r.length = 1.0;
  EXPECT_TRUE(near_abs(r.height_at(0.2), -1e-3, 1e-18));
  EXPECT_TRUE(near_abs(r.height_at(0.45), -0.25e-3, 1e-15));
  EXPECT_TRUE(near_abs(r.height_at(-0.05), -0.25e-3, 1e-15));
  EXPECT_EQ(r.height_at(0.71), 0.0);
}

TEST(Irregularity, corrugation_fades_in) {
  fem::Irregularity r;
  r.kind = fem::IrregularityKind::corrugation;
  r.position = -1.0, r.depth = 2e-5, r.length = 0.08;
  EXPECT_EQ(r.height_at(-1.01), 0.0);
  EXPECT_TRUE(near_abs(r.height_at(-1.0 + 0.02), 2e-5 * 0.15625, 1e-15));
  EXPECT_TRUE(near_abs(r.height_at(-1.0 + 0.10), 2e-5, 1e-12));
}

TEST(Irregularity, table) {
  const std::string path = ::testing::TempDir() + "fem_irregularity.csv";
  std::ofstream(path) << "# x_m, height_m\n0.0, 0.0\n0.5, -1e-3\n1.0 , 1e-3 # hump\n";
  const auto r = fem::read_irregularity_table(path);
  EXPECT_TRUE(near_abs(r.height_at(0.25), -0.5e-3, 1e-15));
  EXPECT_TRUE(near_abs(r.height_at(0.75), 0.0, 1e-15));
  EXPECT_TRUE(near_abs(r.height_at(2.0), 1e-3, 1e-15));
  std::ofstream(path) << "0.0 0.0\n0.0 1e-3\n";
  EXPECT_THROW(fem::read_irregularity_table(path), proto::Error);
  std::remove(path.c_str());
  EXPECT_THROW(fem::read_irregularity_table(path), proto::Error);
}

// One pad cell and the wheel with made-up flexibilities.
fem::InterfaceProblem small_problem() {
  fem::InterfaceProblem p;
  p.laws = {{2e8, 3e4, 5e3, true}};
  p.gap_0 = Eigen::VectorXd::Constant(1, -1e-4);
  p.free_velocity = Eigen::VectorXd::Constant(1, -0.02);
  p.sleeper_velocity = Eigen::VectorXd::Constant(1, 0.01);
  p.carry = Eigen::VectorXd::Constant(1, 150.0);
  p.compliance = Eigen::MatrixXd::Constant(1, 1, 1e-6);
  p.time_factor = 2.5e-5;
  p.contact_column = Eigen::VectorXd::Constant(1, 3e-7);
  p.approach_0 = 1e-4;
  p.contact_slope = 5e-11;
  p.contact_law = fem::hertz_law(9e10);
  return p;
}

fem::InterfaceSolution nothing() {
  return {Eigen::VectorXd::Zero(1), 0.0, 0};
}

TEST(InterfaceSolve, satisfies_both_laws) {
  const auto p = small_problem();
  const auto s = fem::solve_interface(p, nothing(), "test");
  const double used = s.force[0] - 150.0, w = -0.02 - 1e-6 * used - 3e-7 * s.contact;
  EXPECT_TRUE(near_rel(s.force[0], p.laws[0].force(-1e-4 + 2.5e-5 * w, w - 0.01), 1e-10));
  const double approach = 1e-4 - 2.5e-5 * 3e-7 * used - 5e-11 * s.contact;
  EXPECT_TRUE(near_rel(s.contact, 9e10 * std::pow(approach, 1.5), 1e-10));
  EXPECT_GT(s.contact, 0.0);
}

TEST(InterfaceSolve, contact_opens_without_adhesion) {
  auto p = small_problem();
  p.approach_0 = -1e-5;
  auto guess = nothing();
  guess.contact = 8e4;
  EXPECT_EQ(fem::solve_interface(p, guess, "test").contact, 0.0);
}

TEST(InterfaceSolve, pulled_pad_carries_the_clip_only) {
  auto p = small_problem();
  p.gap_0[0] = 5e-4;
  EXPECT_TRUE(near_rel(fem::solve_interface(p, nothing(), "test").force[0], 5e3, 1e-10));
}

TEST(InterfaceSolve, names_place_and_residuals_when_it_fails) {
  auto p = small_problem();
  p.approach_0 = std::nan("");
  try {
    fem::solve_interface(p, nothing(), "window 7");
    FAIL() << "no error";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    EXPECT_NE(std::string(error.what()).find("window 7"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("residuals"), std::string::npos);
  }
}

}  // namespace
