// The wheel's surface: tread profiles, flats and polygons, and how a passage feels them.
#include <cmath>

#include "fem_solver/beam/beam_rail.hpp"
#include "fem_solver/time/wheel_track.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using fem::IrregularityKind;
using tests::near_abs;
using tests::near_rel;
constexpr double pi = 3.14159265358979323846, radius = 0.43;

// EN 13715: flange 28 mm high at -55 mm, the outer cone 1:15, sections that join.
TEST(Tread, s1002_has_its_flange_and_slopes) {
  const auto f = [](double s) { return fem::tread_height(fem::TreadKind::s1002, s * 1e-3) * 1e3; };
  EXPECT_TRUE(near_abs(f(0.0), 0.0, 1e-12));
  EXPECT_TRUE(near_abs(f(-55.0), 28.0, 1e-9));
  EXPECT_TRUE(near_rel((f(50.0) - f(40.0)) / 10, -1.0 / 15, 1e-6));
  for (const double joint : {32.15796, -26.0, -35.0, -38.426669071, -39.764473993, -49.662510381, -62.764705882})
    EXPECT_TRUE(near_abs(f(joint + 1e-7), f(joint - 1e-7), 2e-3)) << joint;
  // Second derivative of section B at the running circle: 2 * 1.565681624e-3 per mm.
  EXPECT_TRUE(near_rel(fem::tread_curvature(fem::TreadKind::s1002, 0.0), 3.131363, 1e-3));
}

TEST(Tread, cones_have_their_slope) {
  EXPECT_TRUE(near_rel(fem::tread_height(fem::TreadKind::cone_1_20, 0.02), -0.001, 1e-12));
  EXPECT_TRUE(near_rel(fem::tread_height(fem::TreadKind::cone_1_40, 0.02), -0.0005, 1e-12));
  EXPECT_TRUE(near_abs(fem::tread_curvature(fem::TreadKind::cone_1_20, 0.0), 0.0, 1e-6));
  EXPECT_TRUE(near_abs(fem::tread_height(fem::TreadKind::cone_1_20, -0.055), 0.028, 1e-9));
}

fem::Irregularity flat(IrregularityKind kind, double length, double depth) {
  return {kind, 0.3, depth, length, radius, {}, {}};
}

// A chord of length L lies L^2/(8 R) below the arc; tipping over its edge the centre runs on a circle of the wheel's
// radius about that edge, so that its path meets the level with the slope zero and the middle with L/(2 R).
TEST(FreshFlat, is_the_path_of_a_wheel_that_tips_over_the_chord) {
  const double length = 0.06;
  const auto r = flat(IrregularityKind::fresh_flat, length, 0.0);
  EXPECT_TRUE(near_rel(r.height_at(0.3), -length * length / (8 * radius), 2e-3));
  EXPECT_EQ(r.height_at(0.3 - 0.031), 0.0);
  EXPECT_TRUE(near_rel((r.height_at(0.3) - r.height_at(0.3 - 1e-5)) / 1e-5, -length / (2 * radius), 5e-3));
  EXPECT_TRUE(near_rel((r.height_at(0.3 + 1e-5) - r.height_at(0.3)) / 1e-5, length / (2 * radius), 5e-3));
  const double edge = 0.3 - length / 2;
  for (const double s : {0.005, 0.02}) {
    const double fallen = radius + r.height_at(edge + s);
    EXPECT_TRUE(near_rel(std::hypot(fallen, s), radius, 1e-12));
  }
  EXPECT_TRUE(near_abs(r.height_at(0.3 + 2 * pi * radius * 3), r.height_at(0.3), 1e-12));
}

TEST(RoundedFlat, has_depth_and_smooth_ends) {
  const auto r = flat(IrregularityKind::rounded_flat, 0.08, 1e-3);
  EXPECT_TRUE(near_rel(r.height_at(0.3), -1e-3, 1e-12));
  EXPECT_TRUE(near_rel(r.height_at(0.32), -0.5e-3, 1e-12));
  EXPECT_TRUE(near_abs(r.height_at(0.3401), 0.0, 1e-15));
  EXPECT_TRUE(near_rel(r.height_at(0.31 - 2 * pi * radius), r.height_at(0.31), 1e-9));
}

TEST(Polygon, closes_after_a_turn) {
  const fem::Irregularity r{IrregularityKind::corrugation, -20.0, 3e-5, 2 * pi * radius / 18, 0.0, {}, {}};
  for (const double x : {0.01, 0.05, 0.11})
    EXPECT_TRUE(near_abs(r.height_at(x + 2 * pi * radius), r.height_at(x), 1e-12));
}

struct Imposed {
  const char* name;
  fem::Irregularity rail, wheel;
  friend void PrintTo(const Imposed& i, std::ostream* out) { *out << i.name; }
};
class Standing : public ::testing::TestWithParam<Imposed> {};

// A wheel that stands at a place of the irregularity stands higher by its height, nothing else changed.
TEST_P(Standing, is_displaced_by_the_height) {
  const auto settings = tests::small_track();
  const fem::BeamRail rail(settings, {tests::rail_seat(0.0)}, fem::SeatOwner::own_supports);
  bool felt = false;
  for (const double x : {0.28, 0.29, 0.3, 0.31, 0.33}) {
    fem::WheelSettings wheel;
    wheel.start = x;
    const double smooth = fem::WheelTrack(rail, settings, wheel, 5e-5, {}).state().wheel.hub();
    wheel.irregularity = GetParam().rail, wheel.defect = GetParam().wheel;
    const double height = wheel.irregularity.height_at(x) + wheel.defect.height_at(x);
    const double rough = fem::WheelTrack(rail, settings, wheel, 5e-5, {}).state().wheel.hub();
    EXPECT_TRUE(near_abs(rough - smooth, height, 1e-15));
    felt = felt || std::abs(height) > 1e-5;
  }
  EXPECT_TRUE(felt);
}

const fem::Irregularity corrugated{IrregularityKind::corrugation, -3.0, 3e-5, 0.05, 0.0, {}, {}};
const fem::Irregularity squat{IrregularityKind::table, 0, 0, 1, 0, {0.27, 0.29, 0.31, 0.33}, {0, -2e-4, -2e-4, 0}};
INSTANTIATE_TEST_SUITE_P(
    all, Standing,
    ::testing::Values(Imposed{"fresh_flat", {}, flat(IrregularityKind::fresh_flat, 0.06, 0)},
                      Imposed{"rounded_flat", {}, flat(IrregularityKind::rounded_flat, 0.08, 1e-3)},
                      Imposed{"polygon", {}, corrugated}, Imposed{"corrugation", corrugated, {}},
                      Imposed{"dip", {IrregularityKind::dipped_joint, 0.3, 1e-3, 0.4, 0, {}, {}}, {}},
                      Imposed{"squat", squat, {}},
                      Imposed{"flat_on_squat", squat, flat(IrregularityKind::fresh_flat, 0.06, 0)}),
    [](const auto& imposed) { return std::string(imposed.param.name); });

// The wheel comes down on the flat's far side: the force first falls, then rises above the static one.
TEST(Rolling, over_a_flat_the_force_falls_and_strikes) {
  const auto settings = tests::small_track();
  const fem::BeamRail rail(settings, {tests::rail_seat(0.0)}, fem::SeatOwner::own_supports);
  fem::WheelSettings wheel;
  wheel.start = 0.0, wheel.speed = 20.0;
  wheel.defect = flat(IrregularityKind::fresh_flat, 0.06, 0);
  fem::WheelTrack track(rail, settings, wheel, 5e-5, {});
  double lowest = 1e9, struck = 0.0;
  for (int n = 0; n < 500; ++n) {
    track.march({});
    lowest = std::min(lowest, track.contact_force());
    if (lowest < 0.2 * wheel.static_load) struck = std::max(struck, track.contact_force());
  }
  EXPECT_LT(lowest, 0.2 * wheel.static_load);
  EXPECT_GT(struck, 2 * wheel.static_load);
}

}  // namespace
