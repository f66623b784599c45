// Pads of the own supports that let go or stiffen: against linear tracks where they must agree, and equilibrium where
// they let go.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fem_solver/time/wheel_track.hpp"
#include "tests/support/fem_cases.hpp"
#include "tests/support/fem_rails.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_abs;
using tests::near_rel;

TEST(Law, stiffens_when_pressed_and_lets_go_when_pulled) {
  const fem::InterfaceLaw law{{10.0, 2.0, 3.0, true}, 0.1, 40.0, false};
  EXPECT_TRUE(near_rel(law.force(-0.05, 0.5), -0.5 + 1.0, 1e-12));        // first stiffness and dashpot
  EXPECT_TRUE(near_rel(law.force(-0.3, 0.0), -3.0 - 40.0 * 0.2, 1e-12));  // and the second one beyond 0.1
  EXPECT_TRUE(near_rel(law.force(0.5, 0.0), 3.0, 1e-12));                 // the clip alone
  EXPECT_TRUE(near_rel(law.tangent(-0.3, 0.0, 2.0, 5.0), 50.0 * 2.0 + 2.0 * 5.0, 1e-12));
  EXPECT_EQ(law.tangent(0.5, 0.0, 2.0, 5.0), 0.0);
  auto rest = law;
  rest.beyond_linear = true;
  EXPECT_TRUE(near_rel(rest.force(-0.3, 0.7), law.force(-0.3, 0.7) - (-3.0 + 1.4), 1e-12));
}

// A heavy rail and a light wheel keep every cell of the pads pressed.
struct Track {
  fem::FemSettings settings;
  fem::WheelSettings wheel;
  std::vector<proto::RailSeat> seats{tests::rail_seat(0.0)};
  Track() {
    settings = tests::small_track();
    settings.n_bays = 6;
    settings.gravity = true, settings.material.density *= 10;
    wheel.start = 0.2, wheel.static_load = 1e3;
  }
};

class Pads : public tests::BothRails {
 protected:
  // Wheel, contact force and all displacements after `windows` windows.
  std::pair<fem::RunState, double> run(const Track& t, int windows) {
    const auto rail = GetParam().build(t.settings, t.seats, fem::SeatOwner::own_supports);
    fem::WheelTrack track(*rail, t.settings, t.wheel, 5e-5, {});
    for (int n = 0; n < windows; ++n) track.march({});
    return {track.state(), track.contact_force()};
  }
};

TEST_P(Pads, second_stiffness_from_the_start_is_a_stiffer_linear_pad) {
  Track stiff, bilinear, soft;
  stiff.settings.support.pad_stiffness[2] = 450e6, stiff.seats[0].stiffness[2] = 450e6;
  bilinear.settings.support.pad_second_stiffness = 450e6;
  for (const int windows : {0, 30}) {
    const auto [a, force_a] = run(stiff, windows);
    const auto [b, force_b] = run(bilinear, windows);
    const auto [c, force_c] = run(soft, windows);
    // The solid rail's local indentation is computed on the linear pads, which enters a rolling contact in the fifth
    // digit.
    const double tolerance = windows > 0 && GetParam().name == std::string("solid") ? 1e-4 : 1e-8;
    const double size = a.track.displacement.norm();
    EXPECT_TRUE(near_abs((b.track.displacement - a.track.displacement).norm() / size, 0.0, tolerance)) << windows;
    EXPECT_TRUE(near_rel(force_b, force_a, tolerance)) << windows;
    EXPECT_GT((c.track.displacement - a.track.displacement).norm() / size, 1e-2) << "the pads do not matter";
  }
}

TEST_P(Pads, cut_off_that_is_not_reached_changes_nothing) {
  Track linear, cut;
  cut.settings.support.pad_tension_cutoff = true;
  const auto [a, force_a] = run(linear, 30);
  const auto [b, force_b] = run(cut, 30);
  EXPECT_TRUE(near_abs((b.track.displacement - a.track.displacement).norm() / a.track.displacement.norm(), 0.0, 1e-9));
}

// Largest pull on a pad and the sum of all, upwards on the sleepers, by the full law.
std::pair<double, double> pulls(const fem::TrackSystem& system, const Eigen::VectorXd& u, double clip) {
  double largest = -1e9, sum = 0.0;
  Eigen::Index value = 2;
  for (std::size_t i = 0; i < system.support_seats.size(); ++i) {
    const auto& seat = system.support_seats[i];
    for (int cell = 0; cell < seat.n_cells(); ++cell, value += 3) {
      proto::PadLaw law = seat.cell_law(2);
      law.tension_cutoff = clip >= 0, law.preload = clip * seat.cell_weight();
      const double gap = system.support_cells.row(value).dot(u.head(system.n_rail_dofs)) -
                         u[system.sleeper_dof(static_cast<int>(i), 2)];
      const double force = law.force(gap, 0.0);
      largest = std::max(largest, force * seat.n_cells()), sum += force;
    }
  }
  return {largest, sum};
}

TEST_P(Pads, clips_hold_the_rail_that_lifts) {
  Track t;
  t.settings.gravity = false, t.wheel.static_load = 80e3, t.wheel.start = 0.0;
  const auto linear = GetParam().build(t.settings, t.seats, fem::SeatOwner::own_supports);
  const auto free_pull = pulls(linear->track(), run(t, 0).first.track.displacement, -1).first;
  const double clip = free_pull / 4;
  t.settings.support.pad_tension_cutoff = true, t.settings.support.pad_clip_preload = clip;
  const auto rail = GetParam().build(t.settings, t.seats, fem::SeatOwner::own_supports);
  for (const int windows : {0, 1}) {
    const auto state = run(t, windows).first;
    const auto [largest, sum] = pulls(rail->track(), state.track.displacement, clip);
    std::printf("%s: pads pull %.1f N without cut-off, %.1f N with a clip of %.1f N\n", GetParam().name, free_pull,
                largest, clip);
    EXPECT_TRUE(near_rel(largest, clip, 1e-9));
    EXPECT_TRUE(near_rel(sum, -80e3, windows == 0 ? 1e-8 : 1e-2)) << "equilibrium";
  }
}

INSTANTIATE_TEST_SUITE_P(rails, Pads, tests::BothRails::kinds(), tests::BothRails::name);

}  // namespace
