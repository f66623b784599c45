// One light case with both FEM programs, swapped by `coupler run --fem`: a wheel over a dipped joint, the seat's
// sleeper a mass on a spring. Seat forces agree below 500 Hz.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/low_pass.hpp"
#include "tests/support/tolerance.hpp"

namespace {

constexpr double window = 1e-4;  // [s]

const char* light_case = R"([coupling]
window_s = 1e-4
duration_s = 0.06
qdem_command = ["oscillator_participant", "participant", "--side", "explicit"]
[track]
gauge_m = 1.435
sleeper_spacing_m = 0.6
[[rail_seat]]
name = "seat"
origin_m = [0.0, 0.7535, 0.0]
half_lengths_m = [0.075, 0.07]
cells = [1, 1]
stiffness_n_per_m = [0.0, 0.0, 225e6]
damping_ns_per_m = [0.0, 0.0, 30e3]
[oscillator.explicit]
mass_kg = 150.0
ground_stiffness_n_per_m = 150e6
initial_displacement_m = 0.0
initial_velocity_m_per_s = 0.0
[oscillator.implicit]
mass_kg = 1.0
ground_stiffness_n_per_m = 1.0
initial_displacement_m = 0.0
initial_velocity_m_per_s = 0.0
[fem]
n_bays = 10
element_length_m = 0.15
gravity = false
[fem.support]
pad_cells = [3, 3]
pad_stiffness_n_per_m = [60e6, 60e6, 225e6]
pad_damping_ns_per_m = [15e3, 15e3, 30e3]
[wheel]
speed_m_per_s = 40.0
start_m = -1.8
static_load_n = 65e3
unsprung_mass_kg = 600.0
radius_m = 0.43
[wheel.irregularity]
kind = "dipped_joint"
depth_m = 0.3e-3
length_m = 0.6
position_m = -0.4
)";

struct Histories {
  std::vector<double> seat, contact;  ///< of every window [N]
};

Histories run(const std::string& fem) {
  tests::CoupledRun coupled(light_case);
  coupled.start({"run", coupled.case_path(), "--out", coupled.out(), "--fem", fem});
  EXPECT_EQ(coupled.wait(250.0).value_or(-1), 0) << coupled.message();
  Histories result;
  const proto::ResultReader reader(coupled.out() + "/coupling.h5");
  const auto n = reader.n_committed();
  const auto impulse = reader.read_rows("/seats/seat/impulse", n).values;
  for (std::size_t row = 1; row < n; ++row) result.seat.push_back(impulse[3 * row + 2] / window);
  const proto::ResultReader wheel(coupled.out() + "/fem.h5");
  result.contact = wheel.read_rows("/TimeSeries/wheel/contact_force", wheel.n_committed("/TimeSeries")).values;
  return result;
}

constexpr int half_width = 60;  // of the filter, in windows

/// RMS of b - a over that of a, the ends left out.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> apart, whole;
  for (std::size_t i = half_width; i + half_width < a.size(); ++i) apart.push_back(b[i] - a[i]), whole.push_back(a[i]);
  return tests::rms(apart) / tests::rms(whole);
}

/// The parts below and above 500 Hz.
struct Bands {
  explicit Bands(const std::vector<double>& values)
      : low(tests::low_pass(values, window, 500.0, half_width)), high(values) {
    for (std::size_t i = 0; i < high.size(); ++i) high[i] -= low[i];
  }
  std::vector<double> low, high;
};

TEST(SolidAndBeam, seat_force_within_5_percent_below_500_hz) {
  const Histories solid = run("solid"), beam = run("beam");
  ASSERT_EQ(solid.seat.size(), 600u);
  ASSERT_EQ(beam.seat.size(), 600u);
  const Bands seat_solid(solid.seat), seat_beam(beam.seat), contact_solid(solid.contact), contact_beam(beam.contact);
  const double seat = difference(seat_solid.low, seat_beam.low);
  std::printf(
      "below 500 Hz: seat force %.2f %%, contact force %.2f %%; above: %.1f %%, %.1f %% (solid: %.0f N, %.0f N)\n",
      100 * seat, 100 * difference(contact_solid.low, contact_beam.low),
      100 * difference(seat_solid.high, seat_beam.high), 100 * difference(contact_solid.high, contact_beam.high),
      tests::rms(seat_solid.high), tests::rms(contact_solid.high));
  const auto most = [](const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()) * 1e-3; };
  const auto least = [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()) * 1e-3; };
  std::printf("solid: contact %.2f to %.2f kN, seat %.2f kN; beam: %.2f to %.2f kN, %.2f kN\n", least(solid.contact),
              most(solid.contact), -least(solid.seat), least(beam.contact), most(beam.contact), -least(beam.seat));
  EXPECT_GT(most(solid.contact), 75.0) << "the joint does nothing";
  EXPECT_LT(seat, 0.05);
}

TEST(SolidAndBeam, a_program_that_is_not_there_is_named) {
  tests::CoupledRun coupled(light_case);
  EXPECT_EQ(coupled.run({"run", coupled.case_path(), "--out", coupled.out(), "--fem", "fem_bean"}).value_or(-1),
            static_cast<int>(proto::ExitCode::missing_input));
  EXPECT_TRUE(tests::contains(coupled.message(), "there is no program 'fem_bean' - --fem")) << coupled.message();
}

TEST(SolidAndBeam, both_check_the_case) {
  for (const char* fem : {"solid", "beam"}) {
    tests::CoupledRun coupled(light_case);
    EXPECT_EQ(coupled.run({"check", coupled.case_path(), "--fem", fem}).value_or(-1), 0) << coupled.message();
  }
}

}  // namespace
