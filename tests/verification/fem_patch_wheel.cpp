// The wheel on a resolved patch, rolling over a rail of beam elements: Hertz where Hertz holds, the drive's balance of
// torques, rollback, and what is refused.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "fem_solver/beam/beam_rail.hpp"
#include "fem_solver/contact/patch_ellipse.hpp"
#include "fem_solver/time/wheel_track.hpp"
#include "proto/error.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_abs;
using tests::near_rel;

constexpr double step = 5e-5;

/// 65 kN at 40 m/s, its contact a patch without creepage.
fem::WheelSettings patch_wheel() {
  fem::WheelSettings wheel;
  wheel.start = -0.6;
  wheel.patch = fem::PatchSettings{};
  wheel.patch->geometry = {1 / wheel.radius, 1 / wheel.rail_crown_radius, {}, 0.0};
  return wheel;
}

class Passage : public ::testing::Test {
 protected:
  std::vector<double> forces(const fem::WheelSettings& wheel, int n_windows) const {
    fem::WheelTrack track(*rail_, settings_, wheel, step, {});
    std::vector<double> result;
    for (int n = 0; n < n_windows; ++n) track.march({}), result.push_back(track.contact_force());
    return result;
  }

  fem::WheelTrack track(const fem::WheelSettings& wheel, double window = step) const {
    return fem::WheelTrack(*rail_, settings_, wheel, window, {});
  }

  fem::FemSettings settings_ = tests::small_track();
  std::unique_ptr<fem::RailModel> rail_ =
      fem::build_beam_rail(settings_, {tests::rail_seat(0.0)}, fem::SeatOwner::own_supports);
};

// A rail wave so long that the patch sees it as a plane (its curvature is 1.5 % of the wheel's), and so high that the
// wheel leaves the rail in between.
TEST_F(Passage, force_within_2_percent_of_hertz) {
  fem::WheelSettings wheel = patch_wheel();
  wheel.irregularity.kind = fem::IrregularityKind::corrugation;
  wheel.irregularity.depth = 2.2e-4, wheel.irregularity.length = 0.5, wheel.irregularity.position = -0.6;
  const auto patch = forces(wheel, 500);
  wheel.patch.reset();
  const auto hertz = forces(wheel, 500);
  double largest = 0.0;
  for (std::size_t n = 0; n < patch.size(); ++n) largest = std::max(largest, std::abs(patch[n] - hertz[n]));
  std::printf("contact force %.1f to %.1f kN; patch and Hertz differ by at most %.2f %% of the static load\n",
              *std::min_element(hertz.begin(), hertz.end()) * 1e-3,
              *std::max_element(hertz.begin(), hertz.end()) * 1e-3, largest / wheel.static_load * 100);
  EXPECT_EQ(*std::min_element(patch.begin(), patch.end()), 0.0);
  EXPECT_GT(*std::max_element(patch.begin(), patch.end()), 1.5 * wheel.static_load);
  EXPECT_LT(largest, 0.02 * wheel.static_load);
}

TEST_F(Passage, eight_elements_to_the_shorter_semi_axis_at_rest) {
  const auto run = track(patch_wheel());
  const auto ellipse = fem::fit_ellipse(run.patch()->grid(), run.state().patch.pressure);
  const double shorter =
      std::min(ellipse.semi_axis_x / run.patch()->grid().dx, ellipse.semi_axis_y / run.patch()->grid().dy);
  EXPECT_TRUE(near_abs(shorter, 8.0, 0.1));
}

// A profile of the rail and one of the wheel that together are the crown of 0.3 m.
TEST_F(Passage, profiles_that_are_a_crown_give_its_force) {
  fem::WheelSettings wheel = patch_wheel();
  const auto crown = forces(wheel, 40);
  std::vector<double> y, flat, round;
  for (int k = -20; k <= 20; ++k) {
    y.push_back(1e-3 * k), flat.push_back(0.0);
    round.push_back(-y.back() * y.back() / 2 / 0.3);
  }
  wheel.patch->geometry = {1 / wheel.radius, 0.0, {{y, flat}, {y, round}}, 0.0};
  const auto profiles = forces(wheel, 40);
  for (std::size_t n = 0; n < crown.size(); ++n) ASSERT_TRUE(near_rel(profiles[n], crown[n], 1e-3));
}

// A rail that is curved along its length by 0.5 m under the patch adds that to the wheel's curvature.
TEST(PatchGap, adds_the_rails_own_curvature) {
  fem::WheelSettings wheel = patch_wheel();
  wheel.irregularity.kind = fem::IrregularityKind::table;
  for (int k = -300; k <= 300; ++k) {
    const double x = 1e-4 * k;
    wheel.irregularity.x.push_back(wheel.start + x);
    wheel.irregularity.height.push_back(-x * x / 2 / 0.5);
  }
  double approach = 0.0;
  fem::PatchContact(wheel, step).at_rest(wheel.start, approach);
  const fem::Hertz hertz(1 / (1 / 0.43 + 1 / 0.5), 0.3, {}, {});
  EXPECT_TRUE(near_rel(approach, hertz.at_force(wheel.static_load).approach, 0.01));
}

// Once it no longer spins up, the shear takes what the torque gives; the creepage is that of steady rolling.
TEST_F(Passage, shear_balances_the_torque) {
  for (const double torque : {2000.0, -2000.0}) {
    fem::WheelSettings wheel = patch_wheel();
    wheel.patch->drive = fem::WheelDrive{torque, 15.0};
    auto run = track(wheel);
    for (int n = 0; n < 150; ++n) run.march({});
    const auto& state = run.state().patch;
    const auto& grid = run.patch()->grid();
    const double pull = fem::resultant(grid, state.traction).longitudinal;
    const double creepage = run.patch()->creepage(state).longitudinal;
    fem::RollingPatch rolling(grid, fem::pair_elasticity(wheel.wheel, wheel.rail));
    const auto steady = rolling.steady(0.3 * state.pressure, state.traction, {creepage, 0.0, 0.0}, "test");
    std::printf("torque %.0f N m: shear %.1f N (%.1f), creepage %.3e, which asks for %.1f N\n", torque, pull,
                torque / wheel.radius, creepage, fem::resultant(grid, steady.traction).longitudinal);
    EXPECT_TRUE(near_rel(pull, torque / wheel.radius, 0.02));
    EXPECT_LT(creepage * torque, 0.0);
    EXPECT_TRUE(near_rel(fem::resultant(grid, steady.traction).longitudinal, pull, 0.03));
  }
}

TEST_F(Passage, goes_back_and_repeats_its_bits) {
  fem::WheelSettings wheel = patch_wheel();
  wheel.patch->creepage = {-1e-3, 5e-4, 0.2};
  auto run = track(wheel);
  for (int n = 0; n < 5; ++n) run.march({});
  const fem::RunState saved = run.state();
  for (int n = 0; n < 5; ++n) run.march({});
  const fem::RunState once = run.state();
  run.set_state(saved);
  for (int n = 0; n < 5; ++n) run.march({});
  EXPECT_EQ(run.contact_force(), once.last.contact);
  EXPECT_TRUE((run.state().patch.pressure == once.patch.pressure).all());
  EXPECT_TRUE((run.state().patch.traction.x == once.patch.traction.x).all());
  EXPECT_TRUE((run.state().patch.slip.y == once.patch.slip.y).all());
}

/// The error of `action`, which must be one.
template <class Action>
void expect_error(Action&& action, proto::ExitCode code, const std::string& part) {
  try {
    action();
    FAIL() << "no error";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST_F(Passage, refuses_a_travel_above_a_semi_axis) {
  expect_error([&] { track(patch_wheel(), 2e-4); }, proto::ExitCode::config, "more than the contact patch's semi-axis");
  EXPECT_NO_THROW(track(patch_wheel(), 1e-4));
}

TEST_F(Passage, refuses_a_long_loss_of_contact) {
  for (const bool resolved : {true, false}) {
    fem::WheelSettings wheel = patch_wheel();
    if (!resolved) wheel.patch.reset();
    wheel.irregularity.kind = fem::IrregularityKind::dipped_joint;
    wheel.irregularity.depth = 3e-3, wheel.irregularity.length = 0.6;
    wheel.longest_contact_loss = 1e-3;
    expect_error([&] { forces(wheel, 520); }, proto::ExitCode::numerics, "has been off the rail for");
  }
}

TEST(WheelCase, reads_the_patch_and_refuses_bad_friction) {
  const std::string path = ::testing::TempDir() + "fem_patch_wheel.toml";
  const auto read = [&](const std::string& patch) {
    std::ofstream(path)
        << "[wheel]\nspeed_m_per_s = 40\nstart_m = 0\nstatic_load_n = 65e3\nunsprung_mass_kg = 600\nradius_m = "
           "0.43\n"
        << patch;
    return fem::read_wheel(proto::CaseFile::load(path), {});
  };
  const auto wheel =
      read("contact = \"patch\"\n[wheel.patch]\nfriction = 0.25\ntorque_nm = -500\npolar_inertia_kg_m2 = 60\n");
  ASSERT_TRUE(wheel.patch);
  EXPECT_EQ(wheel.patch->friction, 0.25);
  EXPECT_EQ(wheel.patch->drive->torque, -500.0);
  EXPECT_EQ(wheel.patch->geometry.crown_curvature, 1 / 0.3);
  EXPECT_FALSE(read("").patch);
  for (const char* friction : {"-0.01", "1.01"})
    expect_error([&] { read(std::string("contact = \"patch\"\n[wheel.patch]\nfriction = ") + friction + "\n"); },
                 proto::ExitCode::config, "fem_patch_wheel.toml:9:12: wheel.patch.friction");
  expect_error([&] { read("contact = \"patch\"\n[wheel.patch]\nfriction = 0.3\ntorque_nm = 1.0\n"); },
               proto::ExitCode::config, "polar_inertia_kg_m2");
  expect_error([&] { read("[wheel.patch]\nfriction = 0.3\n"); }, proto::ExitCode::config, "wheel.patch");
  std::remove(path.c_str());
}

}  // namespace
