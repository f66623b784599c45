// Test problems with closed forms through three real processes: a forced oscillator (T3), a bar cut in two (T4), an
// impact (T5), a beam under a standing and a moving load (T6, T7), pads that open, a rigid motion (T8), and a rail with
// points of its own.
#include <algorithm>

#include "coupler/mapping/pad_map.hpp"
#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/linear_problems.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using tests::LinearCase;

const std::string program = HOUSE_BIN_DIR "/../test_bin/linear_participant";
const std::string to_round_off =
    "[coupling.iteration]\nforce_tolerance = 1e-13\ndisplacement_tolerance = 1e-13\nat_limit = \"accept\"\n"
    "max_iterations = 20\n";
const std::string converged = "[coupling.iteration]\nforce_tolerance = 1e-9\ndisplacement_tolerance = 1e-9\n";
const std::string two_passes =
    "[coupling.iteration]\nacceleration = \"constant\"\nrelaxation = 1.0\nmax_iterations = 2\nat_limit = \"accept\"\n";

/// Normal components of a column of all seats, [rows][cells].
MatrixXd column(const tests::CoupledRun& run, const LinearCase& c, const std::string& name) {
  const auto problem = tests::linear_problem(c.problem);
  const proto::ResultReader record(run.out() + "/coupling.h5");
  MatrixXd all(0, 0);
  Eigen::Index filled = 0;
  for (std::size_t s = 0; s < problem.seats.size(); ++s) {
    const auto cells = static_cast<std::size_t>(problem.seats[s].n * problem.seats[s].m);
    const auto values = record.read("/seats/seat" + std::to_string(s) + "/" + name).values;
    const std::size_t rows = values.size() / (3 * cells);
    all.conservativeResize(static_cast<Eigen::Index>(rows), filled + static_cast<Eigen::Index>(cells));
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t i = 0; i < cells; ++i)
        all(static_cast<Eigen::Index>(r), filled + static_cast<Eigen::Index>(i)) = values[3 * (cells * r + i) + 2];
    filled += static_cast<Eigen::Index>(cells);
  }
  return all;
}

/// What a run leaves.
struct Ran {
  VectorXd end;         ///< motion at the cells, (u, u', x, x')
  MatrixXd mean_force;  ///< on the sleepers, [windows][cells]
  nlohmann::json summary;
};

Ran run(const LinearCase& c) {
  tests::CoupledRun coupled(c.text(program));
  EXPECT_EQ(coupled.run().value_or(-1), 0) << coupled.message();
  Ran ran;
  ran.summary = coupled.summary();
  if (ran.summary.value("status", "") != "ok") return ran;
  std::vector<VectorXd> parts;
  for (const char* name : {"rail_displacement", "rail_velocity", "sleeper_displacement", "sleeper_velocity"})
    parts.push_back(column(coupled, c, name).bottomRows<1>().transpose());
  ran.end.resize(4 * parts[0].size());
  ran.end << parts[0], parts[1], parts[2], parts[3];
  const auto impulse = column(coupled, c, "impulse");
  ran.mean_force = impulse.bottomRows(impulse.rows() - 1) / c.window_s();
  return ran;
}

MatrixXd identity(const LinearCase& c) {
  const auto problem = tests::linear_problem(c.problem);
  return MatrixXd::Identity(static_cast<Eigen::Index>(problem.n_cells()), problem.rail.points.rows());
}

/// What a scheme is run with.
struct Method {
  const char* label;
  const char* scheme;
  int sub_cycles;
  std::string more;
  friend void PrintTo(const Method& method, std::ostream* out) { *out << method.label << "_" << method.sub_cycles; }
};

LinearCase with(LinearCase c, const Method& method, int n_windows) {
  c.scheme = method.scheme, c.more = method.more, c.sub_cycles = method.sub_cycles, c.n_windows = n_windows;
  return c;
}

void report(const LinearCase& c, const Method& method, const std::vector<double>& steps,
            const std::vector<double>& errors) {
  std::printf("%s, %s m=%d: order %.3f, error %.2e\n", c.problem.c_str(), method.label, method.sub_cycles,
              tests::fitted_order(steps, errors), errors.back());
}

/// Order of the error at the end against `exact` over the last two halvings.
::testing::AssertionResult is_of_second_order(const LinearCase& c, const Method& method, const VectorXd& exact,
                                              const std::vector<int>& windows = {160, 320, 640}) {
  std::vector<double> steps, errors;
  for (const int n : windows) {
    steps.push_back(1.0 / n);
    errors.push_back((run(with(c, method, n)).end - exact).norm());
  }
  report(c, method, steps, errors);
  return tests::converges_with_order(steps, errors, 2.0, 0.15);
}

/// Root mean square over windows and seats of the difference of two runs' mean forces, the finer one averaged.
double distance(const MatrixXd& coarse, const MatrixXd& fine) {
  const Eigen::Index factor = fine.rows() / coarse.rows();
  double sum = 0.0;
  for (Eigen::Index n = 0; n < coarse.rows(); ++n)
    sum += (coarse.row(n) - fine.middleRows(n * factor, factor).colwise().mean()).squaredNorm();
  return std::sqrt(sum / static_cast<double>(coarse.rows()));
}

const std::vector<Method> methods{{"R1", "R1", 1, ""},
                                  {"R1", "R1", 10, ""},
                                  {"R1", "R1", 50, ""},
                                  {"R2", "R2", 10, ""},
                                  {"P2", "implicit", 10, two_passes},
                                  {"implicit", "implicit", 1, converged},
                                  {"implicit", "implicit", 10, converged},
                                  {"implicit", "implicit", 50, converged}};

class OfMethod : public ::testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(With, OfMethod, ::testing::ValuesIn(methods), [](const auto& test) {
  return std::string(test.param.label) + "_" + std::to_string(test.param.sub_cycles);
});

TEST_P(OfMethod, T3ForcedOscillatorStaysInItsSteadyState) {
  const auto amplitudes = tests::forced_amplitudes();
  const double end = tests::forced().end_time;
  const std::complex<double> rate(0, tests::drive_frequency), turn = std::exp(rate * end);
  VectorXd exact(4);
  exact << (amplitudes[0] * turn).real(), (rate * amplitudes[0] * turn).real(), (amplitudes[1] * turn).real(),
      (rate * amplitudes[1] * turn).real();
  EXPECT_TRUE(is_of_second_order({"forced"}, GetParam(), exact));
}

TEST(T4, TheCutBarInItsFirstModeIsOfSecondOrderInTime) {
  const LinearCase c{"split_bar"};
  // The first mode of the elements' bar; its frequency is that of one bar of 16 elements.
  const double h = 1.0 / 16, w = 2 / h * std::sin(M_PI / 2 * h / 2), end = tests::split_bar().end_time;
  const double u = std::sin(M_PI / 4) * std::cos(w * end), v = -std::sin(M_PI / 4) * w * std::sin(w * end);
  VectorXd exact(4);
  exact << u, v, u, v;
  EXPECT_TRUE(is_of_second_order(c, {"PH", "PH", 10, ""}, exact));
}

TEST_P(OfMethod, T5ImpactWhileTheBarsPressIsOfSecondOrder) {
  const LinearCase c{"impact"};
  const auto exact = tests::exact_motion(tests::impact(20), identity(c), tests::impact(20).end_time);
  EXPECT_TRUE(is_of_second_order(c, GetParam(), exact, {320, 640, 1280}));
}

TEST(T5, ImpactGivesTheSquareWaveAndAllMomentum) {
  LinearCase c{"fine_impact", "implicit"};
  c.more = to_round_off, c.n_windows = 1280, c.end_time = 3.2;
  const auto ran = run(c);
  // Two endless bars of impedance 1 through the pad: F = F_1 - (F_1 - F_0) e^{-rt}, F_1 half the velocity.
  const double k = 10.0, damping = 0.1, last = 0.5, first = damping / (1 + 2 * damping),
               rate = 2 * k / (1 + 2 * damping);
  double impulse = 0.0, largest = 0.0;
  for (Eigen::Index n = 0; n < ran.mean_force.rows(); ++n) {
    const double time = c.window_s() * static_cast<double>(n + 1);
    impulse -= c.window_s() * ran.mean_force(n, 0);
    largest = std::max(largest, -ran.mean_force(n, 0));
    const double exact = last * time - (last - first) * (1 - std::exp(-rate * time)) / rate;
    if (n == 640) {  // 1.6: the waves return at 2
      EXPECT_TRUE(tests::near_rel(impulse, exact, 0.01));
    }
  }
  std::printf("largest mean force %.3f of %.3f, impulse %.4f of 1\n", largest, last, impulse);
  EXPECT_TRUE(tests::near_rel(impulse, 1.0, 0.01)) << "equal bars change their velocities";
  EXPECT_TRUE(tests::near_abs(largest / last, 1.0, 0.05)) << "overshoot of the elements' bar";
  EXPECT_LT(ran.summary["interface"]["momentum_defect_relative"], 1e-13);
  EXPECT_LT(ran.summary["interface"]["energy_defect_relative"], 1e-12);
}

/// Displacement of the rail at the load, and the sum of the seats' forces at the end.
std::pair<double, double> static_beam(const std::string& problem, const std::string& scheme) {
  LinearCase c{problem, scheme};
  c.end_time = 40.0, c.n_windows = 400, c.sub_cycles = 10;
  const auto ran = run(c);
  const auto n = ran.end.size() / 4;
  return {ran.end[n / 2], ran.mean_force.bottomRows<1>().sum()};
}

TEST(T6, TheStaticBeamOnPadsIsThatOnAFoundation) {
  const double exact = tests::WinklerBeam{}.deflection(0.0)[0];
  for (const auto* scheme : {"R1", "implicit"}) {
    const auto [coarse, force] = static_beam("static_beam", scheme);
    std::printf("%s: deflection at the load %.6f of %.6f, seats carry %.12f of -1\n", scheme, coarse, exact, force);
    EXPECT_TRUE(tests::near_rel(coarse, exact, 1e-2));
    EXPECT_TRUE(tests::near_abs(force, -1.0, 1e-9));
  }
  const auto coarse = static_beam("static_beam", "R1").first, fine = static_beam("fine_static_beam", "R1").first;
  EXPECT_LT(std::abs(fine - exact), std::abs(coarse - exact) / 4) << "seats at half the distance";
}

class T7 : public ::testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(With, T7,
                         ::testing::Values(Method{"R1", "R1", 10, ""}, Method{"R2", "R2", 10, ""},
                                           Method{"implicit", "implicit", 10, converged}),
                         [](const auto& test) { return test.param.label; });

TEST_P(T7, AMovingLoadIsFollowedAtSecondOrder) {
  std::vector<double> steps, distances;
  Ran before;
  for (const int n : {160, 320, 640, 1280}) {
    auto ran = run(with({"moving_load"}, GetParam(), n));
    if (n > 160) steps.push_back(1.0 / n), distances.push_back(distance(before.mean_force, ran.mean_force));
    before = std::move(ran);
  }
  report({"moving_load"}, GetParam(), steps, distances);
  EXPECT_TRUE(tests::converges_with_order(steps, distances, 2.0, 0.15));
}

TEST(MovingLoad, AMovingLoadBelowTheCriticalSpeedCarriesItsDeflectionAlong) {
  const LinearCase c{"moving_load", "R1", "none", "", 640, 10};
  const auto ran = run(c);
  const tests::WinklerBeam beam{0.5, 1.0};
  const auto problem = tests::linear_problem("moving_load");
  double largest = 0.0, error = 0.0;
  for (std::size_t i = 0; i < problem.seats.size(); ++i) {
    const double exact = beam.deflection(problem.seats[i].x - 1.0)[0];  // the load has gone from -1 to 1
    largest = std::max(largest, std::abs(exact));
    error = std::max(error, std::abs(ran.end[static_cast<Eigen::Index>(i)] - exact));
  }
  std::printf("largest deflection %.5f, largest error %.5f\n", largest, error);
  EXPECT_TRUE(tests::near_abs(error / largest, 0.0, 0.02));
}

TEST(Uplift, R1ConvergesToTheImplicitAnswerAtSecondOrderWithTheSameLawOnBothSides) {
  const Method implicit{"implicit", "implicit", 10, converged}, robin{"R1", "R1", 10, ""};
  const auto reference = run(with({"uplift"}, implicit, 2560));
  const double clip = 2e-3, pulled = reference.mean_force.maxCoeff();
  EXPECT_TRUE(tests::near_rel(pulled, clip, 1e-9)) << "no pad opened";
  std::vector<double> steps, errors;
  for (const int n : {160, 320, 640}) {
    steps.push_back(1.0 / n);
    errors.push_back(distance(run(with({"uplift"}, robin, n)).mean_force, reference.mean_force));
    std::printf("H = T/%d: %.3e N\n", n, errors.back());
  }
  report({"uplift"}, robin, steps, errors);
  EXPECT_TRUE(tests::converges_with_order(steps, errors, 2.0, 0.15));
  auto other_law = with({"uplift"}, robin, 640);
  other_law.fault = "no_cutoff";
  const double lasting = distance(run(other_law).mean_force, reference.mean_force);
  std::printf("a rail without the cut-off: %.3e N\n", lasting);
  EXPECT_GT(lasting, 10 * errors.back());
}

TEST(T8, ARigidMotionGivesNoForceThroughPointsOffThePlaneEither) {
  for (const auto* scheme : {"R1", "implicit", "E1"}) {
    LinearCase c{"rigid_plate", scheme};
    // The iteration has nothing to be relative to but round-off.
    c.more = to_round_off + "[coupling.advisor]\naccept_unstable = true\n";
    const auto ran = run(c);
    // Moved by some 1 m; k 10 N/m.
    EXPECT_LT(ran.mean_force.lpNorm<Eigen::Infinity>(), 1e-12) << scheme;
    EXPECT_LT(ran.summary["rail_seats"][0]["max_force_n"], 1e-12) << scheme;
  }
}

/// The normal operator from the rail's points to the cells, as the coupler makes it.
MatrixXd plate_map(const tests::LinearProblem& problem) {
  proto::RailSeat seat;
  seat.name = "seat0";
  seat.origin.setZero(), seat.axes.setIdentity();
  seat.half_lengths = {0.1, 0.1}, seat.cells = {3, 3};
  proto::SeatRegistration r;
  r.own_points = true;
  for (const auto& point : problem.rail_points) r.points.insert(r.points.end(), point.data(), point.data() + 3);
  const auto all = coupler::map_to_pad("fem", {{}, {r}}, {seat})->pad_map();
  MatrixXd map(9, 16);
  for (Eigen::Index i = 0; i < 9; ++i)
    for (Eigen::Index j = 0; j < 16; ++j) map(i, j) = all.at(static_cast<std::size_t>((3 * i + 2) * 48 + 3 * j + 2));
  return map;
}

TEST_P(OfMethod, ARailWithPointsOfItsOwnIsOfSecondOrder) {
  const auto problem = tests::plate(true);
  EXPECT_TRUE(
      is_of_second_order({"plate"}, GetParam(), tests::exact_motion(problem, plate_map(problem), problem.end_time)));
}

TEST(OwnPoints, AnotherOperatorInTheRailsPadLeavesAnErrorThatStaysAndIsToldOf) {
  const auto problem = tests::plate(true);
  const auto exact = tests::exact_motion(problem, plate_map(problem), problem.end_time);
  std::vector<double> errors;
  for (const int n : {160, 640}) {
    LinearCase c{"plate", "R1", "nearest_point"};
    c.n_windows = n;
    const auto ran = run(c);
    errors.push_back((ran.end - exact).norm() / exact.norm());
    const auto warnings = ran.summary["warnings"].dump();
    EXPECT_TRUE(tests::contains(warnings, "the pad of fem is ")) << warnings;
  }
  std::printf("error %.2e, with a quarter of the window %.2e\n", errors[0], errors[1]);
  EXPECT_GT(errors[1], 0.01);
  EXPECT_GT(errors[1], 0.8 * errors[0]) << "it falls with the window";
}

}  // namespace
