// The wheel of solid elements: mass and inertia, modes and stiffness against closed forms, and its limits.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fem_solver/beam/beam_rail.hpp"
#include "fem_solver/time/wheel_track.hpp"
#include "fem_solver/wheel/solid_wheel.hpp"
#include "proto/error.hpp"
#include "tests/support/annulus.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_abs;
using tests::near_rel;

constexpr double pi = 3.14159265358979323846, degree = pi / 180;

fem::Meridian disc(double inner, double outer, double thickness, int rows) {
  fem::Meridian m;
  m.bore_radius = inner;
  for (int row = 0; row <= rows; ++row)
    for (const double side : {-0.5, 0.5})
      m.vertices.emplace_back(side * thickness, outer + (inner - outer) * row / rows);
  for (int row = 0; row < rows; ++row) m.quads.push_back({2 * row, 2 * row + 1, 2 * row + 2, 2 * row + 3});
  return m;
}

// Mass and moment of inertia about the axle of the meshed body per density.
std::pair<double, double> meshed(const fem::Meridian& meridian) {
  const fem::SolidMesh mesh(fem::revolved(meridian, fem::wheel_angles(2.5 * degree, 15 * degree)),
                            fem::Edges::revolved_about_y, "test");
  const Eigen::VectorXd volumes = mesh.node_volumes();
  double second = 0.0;
  for (int n = 0; n < mesh.n_nodes(); ++n)
    second += volumes[n] * (std::pow(mesh.nodes()[n][0], 2) + std::pow(mesh.nodes()[n][2], 2));
  return {volumes.sum(), second};
}

TEST(Body, annulus_has_its_volume_and_moment_of_inertia) {
  const auto [volume, second] = meshed(disc(0.1, 0.45, 0.05, 5));
  const double target = pi * (0.45 * 0.45 - 0.1 * 0.1) * 0.05;
  EXPECT_TRUE(near_rel(volume, target, 1e-3));
  EXPECT_TRUE(near_rel(second, target * (0.45 * 0.45 + 0.1 * 0.1) / 2, 3e-3));
}

class Treads : public ::testing::TestWithParam<fem::TreadKind> {};

// Pappus and Guldin on the meridian.
TEST_P(Treads, wheel_has_the_volume_and_moment_of_its_meridian) {
  fem::SolidWheelSettings wheel;
  wheel.tread = GetParam();
  const auto meridian = fem::wheel_meridian(wheel, 0.43);
  const auto [volume, second] = meshed(meridian);
  std::printf("wheel of %.1f kg, %.2f kg m2 about the axle\n", 7850 * volume, 7850 * second);
  EXPECT_TRUE(near_rel(volume, meridian.volume(), 1e-3));
  EXPECT_TRUE(near_rel(second, meridian.second_moment(), 3e-3));
}
INSTANTIATE_TEST_SUITE_P(all, Treads,
                         ::testing::Values(fem::TreadKind::s1002, fem::TreadKind::cone_1_20,
                                           fem::TreadKind::cone_1_40));

// The oracle: breathing of a whole free disc, z J0(z)/J1(z) = 1 - nu, z = 2.067364 for nu = 0.33 (Giurgiutiu,
// Structural Health Monitoring, appendix: vibration of circular plates).
TEST(Oracle, breathing_of_a_free_disc) {
  const tests::Annulus hole{1e-4, 0.5, 210e9, 0.33, 7850};
  const double speed = std::sqrt(210e9 / 7850 / (1 - 0.33 * 0.33));
  EXPECT_TRUE(
      near_rel(tests::annulus_frequencies(hole, 0, 6000, true).front(), 2.067364 * speed / (2 * pi * 0.5), 1e-4));
}

// The five lowest closed-form modes that a radial force excites (n = 0 to 4) are among the reduced ones, each once.
// Others are Ritz vectors that have not converged to a mode.
TEST(Disc, modes_in_its_plane) {
  const tests::Annulus d{0.1, 0.45, 210e9, 0.3, 7850};
  const auto reduced = fem::reduce_wheel(disc(0.1, 0.45, 0.02, 8), {210e9, 0.3, 7850}, 2.5 * degree, 16);
  std::vector<double> exact, found;
  for (int n = 0; n <= 4; ++n)
    for (const double f : tests::annulus_frequencies(d, n, 4500)) exact.push_back(f);
  std::sort(exact.begin(), exact.end());
  ASSERT_EQ(exact.size(), 5u);
  for (const double squared : reduced.circular_squared) found.push_back(std::sqrt(squared) / (2 * pi));
  for (const double f : exact) {
    const auto nearest = std::min_element(found.begin(), found.end(),
                                          [&](double a, double b) { return std::abs(a - f) < std::abs(b - f); });
    std::printf("plane stress %.1f Hz, wheel %.1f Hz (%+.2f %%)\n", f, *nearest, 100 * (*nearest / f - 1));
    EXPECT_TRUE(near_rel(*nearest, f, 0.005));
    found.erase(nearest);
  }
}

TEST(Disc, static_flexibility_under_a_pressed_arc) {
  const tests::Annulus d{0.1, 0.45, 210e9, 0.3, 7850};
  for (const double arc : {2.5, 5.0}) {
    const auto reduced = fem::reduce_wheel(disc(0.1, 0.45, 0.02, 10), {210e9, 0.3, 7850}, arc * degree, 2);
    const double found = reduced.flexibility() + reduced.local_flexibility;
    const double target = tests::annulus_flexibility(d, 0.02, arc * degree);
    std::printf("arc of %.1f deg: %.4g m/N, series %.4g m/N (%+.2f %%)\n", arc, found, target,
                100 * (found / target - 1));
    EXPECT_TRUE(near_rel(found, target, 0.02));
  }
}

// What the patch flattens is taken out as on a half-space: the rest must not depend on the patch.
TEST(Wheel, stiffness_does_not_depend_on_the_patch) {
  const auto meridian = fem::wheel_meridian({}, 0.43);
  const fem::Material steel{210e9, 0.3, 7850};
  const auto fine = fem::reduce_wheel(meridian, steel, 2.5 * degree, 12);
  const auto wide = fem::reduce_wheel(meridian, steel, 4.0 * degree, 12);
  std::printf("radial stiffness %.3g N/m (patch 1.6 times as long: %.3g); local part %.3g and %.3g m/N; modes",
              1 / fine.flexibility(), 1 / wide.flexibility(), fine.local_flexibility, wide.local_flexibility);
  for (int i = 0; i < 6; ++i) std::printf(" %.0f", std::sqrt(fine.circular_squared[i]) / (2 * pi));
  std::printf(" Hz\n");
  EXPECT_TRUE(near_rel(fine.flexibility(), wide.flexibility(), 0.05));
}

// Contact force at every window of a passage over a dipped joint, beam rail.
std::vector<double> contact_forces(const fem::WheelSettings& wheel, const fem::WheelModel& model) {
  const auto settings = tests::small_track();
  const fem::BeamRail rail(settings, {tests::rail_seat(0.0)}, fem::SeatOwner::own_supports);
  fem::WheelTrack track(rail, settings, wheel, model, 5e-5, {});
  std::vector<double> forces;
  for (int n = 0; n < 400; ++n) track.march({}), forces.push_back(track.contact_force());
  return forces;
}

fem::WheelSettings over_a_dip() {
  fem::WheelSettings wheel;
  wheel.start = -0.4;
  wheel.irregularity = {fem::IrregularityKind::dipped_joint, 0.0, 2e-4, 0.4, 0.0, {}, {}};
  return wheel;
}

TEST(Wheel, rigid_limit_is_the_mass) {
  const auto wheel = over_a_dip();
  auto stiff = wheel;
  stiff.wheel.young *= 1e5;
  const auto mass = contact_forces(wheel, fem::mass_wheel(wheel));
  const auto solid = contact_forces(wheel, fem::solid_wheel(stiff));
  double largest = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i) largest = std::max(largest, std::abs(solid[i] - mass[i]));
  std::printf("largest difference %.3g of the static load\n", largest / wheel.static_load);
  EXPECT_TRUE(near_abs(largest / wheel.static_load, 0.0, 1e-3));
  // The elastic one differs: the comparison can fail.
  const auto elastic = contact_forces(wheel, fem::solid_wheel(wheel));
  double apart = 0.0;
  for (std::size_t i = 0; i < mass.size(); ++i) apart = std::max(apart, std::abs(elastic[i] - mass[i]));
  std::printf("elastic wheel: %.3g\n", apart / wheel.static_load);
  EXPECT_GT(apart / wheel.static_load, 0.01);
}

TEST(Wheel, stands_at_rest_on_its_suspension) {
  auto wheel = over_a_dip();
  wheel.speed = 0.0, wheel.irregularity = {};
  wheel.suspension = {1.2e6, 30e3, 65e3 / 9.81 - 600};
  for (const double force : contact_forces(wheel, fem::solid_wheel(wheel)))
    ASSERT_TRUE(near_rel(force, wheel.static_load, 1e-6));
}

TEST(Suspension, frequency_of_two_masses_on_a_spring) {
  fem::WheelSettings settings;
  settings.suspension = {1.2e6, 0.0, 6000};
  const auto model = fem::mass_wheel(settings);
  auto motion = fem::wheel_at_rest(model, 0.0);
  motion.displacement[1] += 1e-3;
  const double step = 1e-5;
  const fem::WheelStepper stepper(model, step);
  const double first = motion.displacement[1] - motion.displacement[0];
  // The gap between the masses swings about its rest; half a period lies between its extremes.
  double last = first;
  int n = 0;
  for (bool turned = false; !turned && n < 100000; ++n) {
    stepper.finish(motion, settings.static_load);
    const double gap = motion.displacement[1] - motion.displacement[0];
    turned = gap > last;
    last = gap;
  }
  const double target = std::sqrt(1.2e6 * (1 / 600.0 + 1 / 6000.0)) / (2 * pi);
  EXPECT_TRUE(near_rel(0.5 / (n * step), target, 2e-3));
}

TEST(Wheel, heavier_than_the_unsprung_mass_is_refused) {
  fem::WheelSettings settings;
  settings.unsprung_mass = 200;
  EXPECT_THROW(fem::solid_wheel(settings), proto::Error);
  settings.unsprung_mass = 600;
  settings.radius = 0.38;  // the web reaches to the tread
  EXPECT_THROW(fem::solid_wheel(settings), proto::Error);
}

}  // namespace
