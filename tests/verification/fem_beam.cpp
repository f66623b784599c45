// The beam rail against closed forms and independent beams: statics, vibration, a moving load, the price of a window.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "fem_solver/beam/beam_rail.hpp"
#include "fem_solver/time/wheel_track.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/timoshenko_beam.hpp"
#include "tests/support/timoshenko_waves.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_abs;
using tests::near_rel;

tests::UniformBeam vertical_beam(const fem::FemSettings& s) {
  const auto section = fem::rail_section(s.profile);
  const auto p = section.properties();
  const double shear = s.material.young / (2 * (1 + s.material.poisson));
  return {s.material.young * p.inertia_vertical, section.shear_vertical * shear * p.area, s.material.density * p.area,
          s.material.density * p.inertia_vertical};
}

/// A seat whose pad is two cells beside the axis, as good as points along the rail.
proto::RailSeat point_seat(double vertical_stiffness, double vertical_damping) {
  auto seat = tests::rail_seat(0.0);
  seat.half_lengths = {1e-6, 0.07};
  seat.cells = {1, 2};
  seat.stiffness = {1.0, 1.0, vertical_stiffness};
  seat.damping = {0.0, 0.0, vertical_damping};
  return seat;
}

void set_supports(fem::FemSettings& s, const proto::RailSeat& seat) {
  s.support.pad_half_lengths = seat.half_lengths, s.support.pad_cells = seat.cells;
  s.support.pad_stiffness = seat.stiffness, s.support.pad_damping = seat.damping;
}

TEST(Element, cantilever_equals_the_closed_form) {
  const auto section = fem::rail_section("60E1");
  const auto p = section.properties();
  const fem::Material steel;
  const double l = 0.7, e = 210e9, g = 210e9 / 2.6;
  const fem::BeamElement element(section, steel, l);
  const Eigen::Matrix<double, 6, 6> tip = element.stiffness().bottomRightCorner<6, 6>();
  const Eigen::Matrix<double, 6, 6> flexibility = tip.inverse();
  EXPECT_TRUE(near_rel(flexibility(0, 0), l / (e * p.area), 1e-12));
  EXPECT_TRUE(near_rel(flexibility(1, 1), l * l * l / (3 * e * p.inertia_lateral) + l / (0.538 * g * p.area), 1e-10));
  EXPECT_TRUE(near_rel(flexibility(2, 2), l * l * l / (3 * e * p.inertia_vertical) + l / (0.393 * g * p.area), 1e-10));
  EXPECT_TRUE(near_rel(flexibility(3, 3), l / (g * 2.212e-6), 1e-12));
  EXPECT_TRUE(near_rel(flexibility(2, 4), -l * l / (2 * e * p.inertia_vertical), 1e-10));
  EXPECT_TRUE(near_rel(flexibility(1, 5), l * l / (2 * e * p.inertia_lateral), 1e-10));
  EXPECT_TRUE(near_rel(element.clamped_flexibility(0.5),
                       l * l * l / (192 * e * p.inertia_vertical) + l / (4 * 0.393 * g * p.area), 1e-10));
  EXPECT_EQ(element.clamped_flexibility(0.0), 0.0);
}

TEST(Element, mass_is_exact_for_rigid_motions) {
  const auto section = fem::rail_section("60E1");
  const auto p = section.properties();
  const double l = 0.3, m = 7850 * p.area * l;
  const fem::BeamKinematics beam(section, {}, {{0.0, l}, 1, l}, 0.0);
  const Eigen::MatrixXd rigid = beam.rigid_motions({l / 2, 0.0, p.centroid_height});
  const Eigen::MatrixXd mass = rigid.transpose() * beam.element().mass() * rigid;
  const Eigen::VectorXd target =
      (Eigen::VectorXd(6) << m, m, m, 7850 * l * (p.inertia_vertical + p.inertia_lateral),
       m * l * l / 12 + 7850 * l * p.inertia_vertical, m * l * l / 12 + 7850 * l * p.inertia_lateral)
          .finished();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) EXPECT_TRUE(near_abs(mass(i, j), i == j ? target[i] : 0.0, 1e-12 * m));
}

class PlaceOnTheRail : public ::testing::TestWithParam<double> {};

TEST_P(PlaceOnTheRail, static_deflection_equals_the_independent_beam) {
  const double x = GetParam(), load = 80e3;
  auto settings = tests::small_track();
  const auto seat = point_seat(225e6, 0.0);
  set_supports(settings, seat);
  const fem::BeamRail rail(settings, {seat}, fem::SeatOwner::own_supports);
  const fem::Statics statics(rail.track(), rail.band());
  const auto place = rail.band().at(x);
  const auto u = statics.solve({}, {}, place, load).displacement;
  const double found = -rail.band().read(place, u) + place.missing_flexibility * load;

  const auto beam = vertical_beam(settings);
  tests::TimoshenkoBeam reference(-3.3, 3.3, 660, beam.bending, beam.shear);
  for (const auto& support : rail.track().support_seats) reference.add_pad({support.origin[0]}, 225e6, 150e6);
  const double target = reference.deflection(x, load)[reference.node(x)];
  std::printf("x = %.2f m: %.6f mm, independent %.6f mm\n", x, found * 1e3, target * 1e3);
  EXPECT_TRUE(near_rel(found, target, 1e-6));
}
INSTANTIATE_TEST_SUITE_P(on_a_seat_a_node_and_between, PlaceOnTheRail, ::testing::Values(0.0, 0.3, 0.07, 0.37));

/// Frequencies [Hz] of the rail alone, of the degrees of freedom `components` of its nodes, ascending.
std::vector<double> frequencies(const fem::BeamRail& rail, const std::vector<int>& components, bool hinged) {
  std::vector<int> dofs;
  const int n = rail.kinematics().n_nodes();
  for (int node = 0; node < n; ++node)
    for (const int c : components)
      if (!hinged || c != components[0] || (node != 0 && node != n - 1)) dofs.push_back(6 * node + c);
  const Eigen::MatrixXd k = Eigen::MatrixXd(rail.track().rail_stiffness).selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd m = Eigen::MatrixXd(rail.track().mass).selfadjointView<Eigen::Lower>();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(k(dofs, dofs), m(dofs, dofs),
                                                                         Eigen::EigenvaluesOnly);
  std::vector<double> result;
  for (const double squared : solver.eigenvalues()) result.push_back(std::sqrt(std::max(squared, 0.0)) / tests::two_pi);
  return result;
}

TEST(Vibration, free_modes_of_the_closed_form) {
  auto settings = tests::small_track();
  settings.n_bays = 4, settings.element_length = 0.1;
  const fem::BeamRail rail(settings, {tests::rail_seat(0.0)}, fem::SeatOwner::own_supports);
  const auto found = frequencies(rail, {2, 4}, false);
  const auto target = tests::free_frequencies(vertical_beam(settings), rail.figures().length, 2000.0);
  ASSERT_GE(target.size(), 6u);
  EXPECT_LT(found[1], 1.0) << "two rigid motions";
  for (std::size_t i = 0; i < 6; ++i) {
    std::printf("free mode %zu: %.2f Hz, closed form %.2f Hz (%+.3f %%)\n", i + 1, found[i + 2], target[i],
                (found[i + 2] / target[i] - 1) * 100);
    EXPECT_TRUE(near_rel(found[i + 2], target[i], i < 3 ? 2e-3 : 0.02));
  }
}

TEST(Vibration, pin_pin_within_2_percent) {
  for (const double element : {0.15, 0.1}) {
    auto settings = tests::small_track();
    settings.n_bays = 0, settings.element_length = element;  // half a bay to each side of one seat: a span
    const fem::BeamRail rail(settings, {tests::rail_seat(0.0)}, fem::SeatOwner::own_supports);
    ASSERT_TRUE(near_rel(rail.figures().length, 0.6, 1e-12));
    const double found = frequencies(rail, {2, 4}, true).front();
    const double target = tests::hinged_frequency(vertical_beam(settings), 0.6);
    std::printf("pin-pin, %.2f m: %.1f Hz, closed form %.1f Hz\n", element, found, target);
    EXPECT_TRUE(near_rel(found, target, 0.02));
    EXPECT_TRUE(near_rel(target, 1064.0, 0.005)) << "the figure of the section's table";
  }
}

TEST(MovingLoad, oracle_of_the_undamped_winkler_beam) {
  const double bending = 210e9 * 3.037e-5, mass = 60.2, k = 50e6, force = 80e3;
  const double critical = std::pow(4 * k * bending / (mass * mass), 0.25);
  const double standing = force * std::pow(k / (4 * bending), 0.25) / (2 * k);
  EXPECT_TRUE(near_rel(critical, 770, 2e-3));
  for (const double share : {0.0, 0.3, 0.6}) {
    const double found =
        tests::moving_load_deflection({bending, 1e14, mass, 0.0}, k, 0.0, force, share * critical, 0.0);
    EXPECT_TRUE(near_rel(found, standing / std::sqrt(1 - share * share), 1e-4)) << share;
  }
}

// Pads every 0.1 m, each with its ballast in series and a sleeper without weight, are a foundation.
TEST(MovingLoad, deflects_as_the_damped_foundation_does) {
  const double k = 20e6, c = 14e3, load = 80e3, speed = 300.0, step = 2.5e-5, begin = -9.0, spacing = 0.1;
  auto settings = tests::small_track();
  settings.sleeper_spacing = settings.element_length = spacing;
  settings.n_bays = 300, settings.loss_factor = 0.0;
  const auto seat = point_seat(2 * k * spacing, 2 * c * spacing);
  set_supports(settings, seat);
  settings.support.sleeper_mass = 1e-3;
  settings.support.ballast_stiffness = {1e6, 1e6, 2 * k * spacing};
  settings.support.ballast_damping = {1e3, 1e3, 2 * c * spacing};
  const fem::BeamRail rail(settings, {seat}, fem::SeatOwner::own_supports);
  const auto& band = rail.band();
  const fem::Newmark newmark(rail.track(), step, 0.0);
  const fem::Statics statics(rail.track(), band);
  auto state = newmark.state_at_rest(statics.solve({}, {}, band.at(begin), load).displacement);
  const int n_windows = 2400;
  for (int n = 0; n < n_windows; ++n) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(rail.track().n_dofs());
    band.add_load(band.at(begin + speed * step * (n + 0.5)), -load, force);
    const Eigen::VectorXd right_side = newmark.right_side(state, force);
    newmark.finish(state, newmark.response(right_side), right_side);
  }
  const auto beam = vertical_beam(settings);
  const double at_rest = tests::moving_load_deflection(beam, k, c, load, 0.0, 0.0);
  const double under_load = tests::moving_load_deflection(beam, k, c, load, speed, 0.0);
  EXPECT_GT(std::abs(under_load / at_rest - 1), 0.05) << "the speed does not matter here";
  for (const double ahead : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    const auto place = band.at(begin + speed * step * n_windows + ahead);
    const double local = ahead == 0.0 ? place.missing_flexibility * load : 0.0;
    const double found = -band.read(place, state.displacement) + local;
    const double target = tests::moving_load_deflection(beam, k, c, load, speed, ahead);
    std::printf("%+.1f m from the load: %.4f mm, closed form %.4f mm\n", ahead, found * 1e3, target * 1e3);
    EXPECT_TRUE(near_abs(found, target, 0.01 * under_load));
  }
}

TEST(Cost, a_window_of_the_long_rail_within_10_ms) {
  const fem::FemSettings settings;
  fem::WheelSettings wheel;
  const auto seat = tests::rail_seat(0.0);
  const fem::BeamRail rail(settings, {seat}, fem::SeatOwner::partner);
  const auto laws = proto::interface_laws({seat});
  fem::WheelTrack track(rail, settings, wheel, 5e-5, laws);
  const auto n = static_cast<Eigen::Index>(laws.size());
  const fem::WindowInput input{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), {}};
  double least = 1.0;
  for (int batch = 0; batch < 20; ++batch) {
    const auto begin = std::chrono::steady_clock::now();
    for (int window = 0; window < 10; ++window) track.march(input);
    least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / 10);
  }
  std::printf("%d unknowns, %.3f ms a window\n", rail.track().n_dofs(), least * 1e3);
  EXPECT_LT(least, 10e-3);
}

}  // namespace
