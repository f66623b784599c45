// The common sections: [coupling], [track], [[rail_seat]].
#include <gtest/gtest.h>

#include "proto/case/coupling.hpp"
#include "proto/case/rail_seat.hpp"
#include "proto/case/track.hpp"
#include "tests/support/case_text.hpp"
#include "tests/support/tolerance.hpp"

using namespace proto;
using tests::CaseText;
using tests::error_of;

namespace {

const std::string seat_text =
    "[[rail_seat]]\nname = \"seat\"\norigin_m = [1, 2, 3]\nhalf_lengths_m = [0.06, 0.04]\ncells = [3, 2]\n"
    "stiffness_n_per_m = [6, 12, 18]\ndamping_ns_per_m = [0.6, 1.2, 1.8]\nclip_preload_n = 60\ntension_cutoff = true\n";

std::string with(const std::string& old_text, const std::string& new_text) {
  auto text = seat_text;
  return text.replace(text.find(old_text), old_text.size(), new_text);
}

std::string seat_refusal(const std::string& text) {
  const CaseText file(text);
  return error_of([&] { read_rail_seats(file.load()); });
}

TEST(RailSeat, cells_fill_the_pad_with_axis_1_fastest) {
  const CaseText file(seat_text);
  const auto seats = read_rail_seats(file.load());
  const auto& seat = seats.at(0);
  ASSERT_EQ(seat.n_cells(), 6);
  EXPECT_TRUE(seat.cell_point(0).isApprox(Eigen::Vector3d(0.96, 1.98, 3)));
  EXPECT_TRUE(seat.cell_point(1).isApprox(Eigen::Vector3d(1.00, 1.98, 3)));
  EXPECT_TRUE(seat.cell_point(5).isApprox(Eigen::Vector3d(1.04, 2.02, 3)));
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int cell = 0; cell < 6; ++cell) mean += seat.cell_weight() * seat.cell_point(cell);
  EXPECT_TRUE(mean.isApprox(seat.origin));
  EXPECT_EQ(n_interface_values(seats), 18u);
}

TEST(RailSeat, the_cells_share_the_pad_and_only_the_normal_is_cut_off) {
  const CaseText file(seat_text);
  const auto laws = interface_laws(read_rail_seats(file.load()));
  ASSERT_EQ(laws.size(), 18u);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const double axis = static_cast<double>(i % 3 + 1);
    EXPECT_TRUE(tests::near_rel(laws[i].stiffness, axis, 1e-15));
    EXPECT_TRUE(tests::near_rel(laws[i].damping, axis / 10, 1e-15));
    EXPECT_EQ(laws[i].preload, i % 3 == 2 ? 10.0 : 0.0);
    EXPECT_EQ(laws[i].tension_cutoff, i % 3 == 2);
  }
}

TEST(RailSeat, a_turned_frame_is_right_handed) {
  const CaseText file(with("cells", "longitudinal_axis = [0, 1, 0]\nlateral_axis = [-1, 0, 0]\ncells"));
  const auto seat = read_rail_seats(file.load()).at(0);
  EXPECT_TRUE(seat.axes.col(2).isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(seat.cell_point(0).isApprox(Eigen::Vector3d(1.02, 1.96, 3)));
}

TEST(RailSeat, bad_seats_are_refused_with_their_place) {
  EXPECT_EQ(seat_refusal(seat_text), "no error");
  EXPECT_EQ(seat_refusal(""), "the case has no rail seat - case.toml - add a [[rail_seat]] table");
  EXPECT_EQ(seat_refusal(with("origin_m = [1, 2, 3]\n", "")),
            "missing key - case.toml:1:1: rail_seat.origin_m - add it");
  EXPECT_EQ(seat_refusal(with("[1, 2, 3]", "[1, 2]")),
            "3 numbers are wanted, found 2 - case.toml:3:12: rail_seat.origin_m");
  EXPECT_EQ(seat_refusal(with("[3, 2]", "[3, 0]")),
            "the value must be between 1 and 64, found 0 - case.toml:5:13: rail_seat.cells[1]");
  EXPECT_EQ(seat_refusal(with("[3, 2]", "[3, 2.5]")),
            "a whole number is wanted, found a number - case.toml:5:13: rail_seat.cells[1]");
  EXPECT_EQ(seat_refusal(with("[6, 12, 18]", "[6, -12, 18]")),
            "the value must be at least 0, found -12 - case.toml:6:25: rail_seat.stiffness_n_per_m[1]");
  EXPECT_EQ(seat_refusal(with("[0.06, 0.04]", "[0, 0.04]")),
            "the value must be greater than 0, found 0 - case.toml:4:19: rail_seat.half_lengths_m[0]");
  EXPECT_EQ(seat_refusal(with("cells", "lateral_axis = [0.1, 1, 0]\ncells")),
            "the longitudinal and lateral axes are not orthonormal - case.toml:5:16: rail_seat.lateral_axis - give two "
            "perpendicular unit vectors");
  EXPECT_EQ(seat_refusal(seat_text + seat_text),
            "two rail seats are called 'seat' - case.toml:11:8: rail_seat.name - give each a name of its own");
}

TEST(Coupling, has_defaults_for_all_but_the_duration) {
  const CaseText file("[coupling]\nduration_s = 0.08\n");
  const auto coupling = read_coupling(file.load());
  EXPECT_EQ(coupling.scheme, Scheme::robin_explicit);
  EXPECT_EQ(coupling.n_windows, 1600u) << "0.08 s of 5e-5 s";
  EXPECT_EQ(coupling.qdem.command, (std::vector<std::string>{"qdem_solver", "participant"}));
  EXPECT_EQ(coupling.initialise.max_windows, 0);
  EXPECT_EQ(coupling.initialise.qdem_residual_limit, 5e-3);
}

TEST(Coupling, limits_of_rest_are_read) {
  const CaseText file(
      "[coupling]\nduration_s = 0.08\n[coupling.initialise]\nmin_windows = 1\nmax_windows = 9\ncheck_windows = 4\n"
      "tolerance = 0.2\nforce_floor_n = 30.0\nqdem_residual_limit = 0.02\nfem_residual_limit = 0.01\n");
  const auto limits = read_coupling(file.load()).initialise;
  EXPECT_EQ(limits.min_windows, 1);
  EXPECT_EQ(limits.max_windows, 9);
  EXPECT_EQ(limits.check_windows, 4);
  EXPECT_EQ(limits.tolerance, 0.2);
  EXPECT_EQ(limits.force_floor, 30.0);
  EXPECT_EQ(limits.qdem_residual_limit, 0.02);
  EXPECT_EQ(limits.fem_residual_limit, 0.01);
}

TEST(Coupling, keys_of_the_schemes_are_read) {
  const CaseText file(
      "[coupling]\nduration_s = 0.08\nscheme = \"implicit\"\nprolongation = \"hermite\"\nsub_cycle_factor = 3\n"
      "[coupling.iteration]\nacceleration = \"aitken\"\nrelaxation = 0.3\nforce_tolerance = 1e-8\n"
      "displacement_tolerance = 1e-9\nmax_iterations = 7\nat_limit = \"accept\"\nreused_windows = 2\nfilter = 0.1\n"
      "[coupling.one_way]\nsupport_stiffness_n_per_m = [1e6, 2e6, 3e6]\n"
      "[coupling.audit]\nenergy = 0.1\nmomentum = 0.2\nmoment = 0.3\naction = \"switch\"\nswitch_to = \"E1\"\n"
      "work_scale_j = 5.0\nimpulse_scale_n_s = 6.0\n"
      "[coupling.advisor]\nrail_mass_kg = 36.0\nsleeper_mass_kg = 150.0\naccept_unstable = true\n");
  const auto c = read_coupling(file.load());
  EXPECT_EQ(c.scheme, Scheme::implicit);
  EXPECT_EQ(c.prolongation, Prolongation::hermite);
  EXPECT_EQ(c.sub_cycle_factor, 3);
  EXPECT_EQ(c.iteration.acceleration, Iteration::Acceleration::aitken);
  EXPECT_EQ(c.iteration.relaxation, 0.3);
  EXPECT_EQ(c.iteration.force_tolerance, 1e-8);
  EXPECT_EQ(c.iteration.displacement_tolerance, 1e-9);
  EXPECT_EQ(c.iteration.max_iterations, 7);
  EXPECT_TRUE(c.iteration.accept_at_limit);
  EXPECT_EQ(c.iteration.reused_windows, 2);
  EXPECT_EQ(c.iteration.filter, 0.1);
  EXPECT_EQ(c.one_way.support_stiffness, (std::vector<double>{1e6, 2e6, 3e6}));
  EXPECT_EQ(c.audit.energy, 0.1);
  EXPECT_EQ(c.audit.momentum, 0.2);
  EXPECT_EQ(c.audit.moment, 0.3);
  EXPECT_EQ(c.audit.action, AuditLimits::Action::switch_scheme);
  EXPECT_EQ(c.audit.switch_to, Scheme::serial_staggered);
  EXPECT_EQ(c.audit.work_scale, 5.0);
  EXPECT_EQ(c.audit.impulse_scale, 6.0);
  EXPECT_EQ(c.advisor.rail_mass, 36.0);
  EXPECT_EQ(c.advisor.sleeper_mass, 150.0);
  EXPECT_TRUE(c.advisor.accept_unstable);
}

TEST(Coupling, schemes_go_by_their_names) {
  for (const auto& name : scheme_names()) EXPECT_EQ(name_of(scheme_of(name)), name);
  EXPECT_EQ(scheme_names().size(), static_cast<std::size_t>(Scheme::rigid_per_window) + 1);
}

TEST(Coupling, bad_values_are_refused) {
  const auto refusal = [](const std::string& text) {
    const CaseText file("[coupling]\n" + text);
    return error_of([&] { read_coupling(file.load()); });
  };
  EXPECT_EQ(refusal(""), "missing key - case.toml:1:1: coupling.duration_s - add it");
  EXPECT_EQ(refusal("window_s = 1e-4\nduration_s = 0.00105\n"),
            "the duration is not a whole number of windows - case.toml:3:14: coupling.duration_s - give a multiple of "
            "window_s");
  EXPECT_EQ(refusal("window_s = 0.1\nduration_s = 0.3\n"), "no error") << "0.3/0.1 is not 3 in binary";
  EXPECT_EQ(refusal("duration_s = 1\nqdem_command = []\n"),
            "the command is empty - case.toml:3:16: coupling.qdem_command - give the program and its first arguments");
  EXPECT_EQ(refusal("duration_s = 1\n[coupling.initialise]\nmin_windows = 5\nmax_windows = 4\n"),
            "min_windows is greater than max_windows - case.toml:4:15: coupling.initialise.min_windows");
  EXPECT_EQ(
      refusal("duration_s = 1\n[coupling.initialise]\nmax_windows = 40\n"),
      "rest is judged over the last 40 windows - case.toml:4:15: coupling.initialise.max_windows - allow more than "
      "check_windows");
  EXPECT_EQ(
      refusal("duration_s = 1\n[coupling.audit]\naction = \"stop\"\n"),
      "a run can be judged on its way only by scales of work and impulse - case.toml:4:10: coupling.audit.action - "
      "give work_scale_j and impulse_scale_n_s, say from the coupling.h5 of a run before");
  EXPECT_EQ(
      refusal("duration_s = 1\n[coupling.audit]\naction = \"switch\"\nswitch_to = \"E2\"\nwork_scale_j = 1\n"
              "impulse_scale_n_s = 1\n"),
      "R1 and E2 load the rail in different ways - case.toml:5:13: coupling.audit.switch_to - R1 can switch to R2; "
      "E0, E1 and E2 to each other and to implicit");
  for (const auto& [from, to] : {std::pair("one_way", "R2"), std::pair("R1", "one_way"), std::pair("GC", "PH")})
    EXPECT_EQ(
        refusal(std::string("duration_s = 1\nscheme = \"") + from + "\"\n[coupling.audit]\naction = \"switch\"\n" +
                "switch_to = \"" + to + "\"\nwork_scale_j = 1\nimpulse_scale_n_s = 1\n"),
        std::string(from) + " and " + to +
            " load the rail in different ways - case.toml:6:13: coupling.audit.switch_to - R1 can switch to R2; "
            "E0, E1 and E2 to each other and to implicit");
  EXPECT_EQ(refusal("duration_s = 1\n[coupling.iteration]\nmax_iteration = 5\n"),
            "unknown key - case.toml:4:1: coupling.iteration.max_iteration - did you mean 'max_iterations'?");
  EXPECT_EQ(refusal("duration_s = 1\n[coupling.initialise]\ntolerence = 5\n"),
            "unknown key - case.toml:4:1: coupling.initialise.tolerence - did you mean 'tolerance'?");
}

TEST(Track, is_read) {
  const CaseText file("[track]\ngauge_m = 1.435\nsleeper_spacing_m = 0.6\n");
  EXPECT_EQ(read_track(file.load()).gauge, 1.435);
  EXPECT_EQ(read_track(file.load()).sleeper_spacing, 0.6);
}

TEST(ShippedCases, have_common_sections_that_can_be_read) {
  for (const char* name : {"split_oscillator", "wheel_passage_quick"}) {
    const auto file = CaseFile::load(std::string(HOUSE_SOURCE_DIR) + "/cases/" + name + "/case.toml");
    EXPECT_GT(read_coupling(file).n_windows, 0u) << name;
    EXPECT_EQ(read_rail_seats(file).size(), 1u) << name;
  }
}

}  // namespace
