// The split oscillator through three real processes against its closed form (test problems T1 and T2): R1, R2, E2, PH
// and the implicit scheme are of second order, E0, E1 and GC are reported as first order, the audit tells them apart.
#include "proto/error.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/oscillator_sides.hpp"
#include "tests/support/tolerance.hpp"

namespace {

constexpr double end_time = 4.0;
const std::string to_round_off =
    "[coupling.iteration]\nforce_tolerance = 1e-14\ndisplacement_tolerance = 1e-14\nat_limit = \"accept\"\n"
    "max_iterations = 12\n";
const std::string two_passes =
    "[coupling.iteration]\nacceleration = \"constant\"\nrelaxation = 1.0\nmax_iterations = 2\nat_limit = \"accept\"\n";

/// A scheme with sub-cycles and further lines of [coupling].
struct Scheme {
  std::string label, name;
  int sub_cycles;
  double order;
  std::string more;
};

tests::OscillatorCase variant_of(const Scheme& scheme, int n_windows) {
  tests::OscillatorCase variant;
  variant.scheme = scheme.name;
  variant.window_s = end_time / n_windows;
  variant.duration_s = end_time;
  variant.largest_step_s = variant.window_s / scheme.sub_cycles;
  variant.more_coupling = scheme.more;
  return variant;
}

nlohmann::json run(const tests::OscillatorCase& variant, int n_windows, int sub_cycles) {
  tests::CoupledRun coupled(variant.text());
  EXPECT_EQ(coupled.run().value_or(-1), 0) << coupled.message();
  auto summary = coupled.summary();
  EXPECT_EQ(summary.value("status", ""), "ok");
  EXPECT_EQ(summary.value("windows", 0), n_windows);
  EXPECT_EQ(summary.value("sub_cycles", 0), sub_cycles);
  return summary;
}

nlohmann::json run(const Scheme& scheme, int n_windows) {
  return run(variant_of(scheme, n_windows), n_windows, scheme.sub_cycles);
}

Eigen::Vector4d end_state(const nlohmann::json& summary) {
  const auto& sides = summary.at("oscillator");
  return Eigen::Vector4d(sides["implicit"]["x"], sides["implicit"]["v"], sides["explicit"]["x"],
                         sides["explicit"]["v"]);
}

class SchemeOrder : public ::testing::TestWithParam<Scheme> {};

/// Slope over the last two halvings, all with H <= T/160.
TEST_P(SchemeOrder, IsReported) {
  const auto& scheme = GetParam();
  const auto exact = tests::exact_state(tests::Oscillator(), end_time);
  const std::vector<int> windows =
      scheme.name == "E0" ? std::vector<int>{640, 1280, 2560} : std::vector<int>{160, 320, 640};
  std::vector<double> steps, errors;
  for (const int n : windows) {
    steps.push_back(end_time / n);
    errors.push_back((end_state(run(scheme, n)) - exact).norm());
    std::printf("%s m=%d H=T/%d: error %.4e\n", scheme.label.c_str(), scheme.sub_cycles, n, errors.back());
  }
  std::printf("%s m=%d: order %.3f\n", scheme.label.c_str(), scheme.sub_cycles, tests::fitted_order(steps, errors));
  EXPECT_TRUE(tests::converges_with_order(steps, errors, scheme.order, 0.15));
}

INSTANTIATE_TEST_SUITE_P(
    Of, SchemeOrder,
    ::testing::Values(Scheme{"R1", "R1", 1, 2, ""}, Scheme{"R1", "R1", 10, 2, ""}, Scheme{"R1", "R1", 50, 2, ""},
                      Scheme{"R2", "R2", 1, 2, ""}, Scheme{"R2", "R2", 10, 2, ""}, Scheme{"R2", "R2", 50, 2, ""},
                      Scheme{"implicit", "implicit", 1, 2, to_round_off},
                      Scheme{"implicit", "implicit", 10, 2, to_round_off},
                      Scheme{"implicit", "implicit", 50, 2, to_round_off},
                      Scheme{"hermite", "implicit", 10, 2, "prolongation = \"hermite\"\n" + to_round_off},
                      Scheme{"P2", "implicit", 1, 2, two_passes}, Scheme{"P2", "implicit", 10, 2, two_passes},
                      Scheme{"P2", "implicit", 50, 2, two_passes}, Scheme{"E2", "E2", 10, 2, ""},
                      Scheme{"E1", "E1", 1, 1, ""}, Scheme{"E1", "E1", 10, 1, ""}, Scheme{"E0", "E0", 10, 1, ""}),
    [](const auto& test) { return test.param.label + "_" + std::to_string(test.param.sub_cycles); });

TEST(RigidJoint, PHIsOfSecondOrderAndGCIsReportedAsFirst) {
  // Both masses as one: u = u0 cos wt, w^2 = (1 + 4)/(1 + 0.5).
  const double w = std::sqrt(5.0 / 1.5), u = std::cos(w * end_time), v = -w * std::sin(w * end_time);
  for (const auto& [name, order] : {std::pair("PH", 2.0), std::pair("GC", 1.0)}) {
    std::vector<double> steps, errors;
    for (const int n : {160, 320, 640}) {
      auto variant = variant_of({name, name, 10, order, name == std::string("GC") ? "sub_cycle_factor = 10\n" : ""}, n);
      variant.sleeper_displacement_m = variant.initial_displacement_m;
      variant.sleeper_velocity_m_per_s = 0.0;
      steps.push_back(end_time / n);
      errors.push_back((end_state(run(variant, n, 10)) - Eigen::Vector4d(u, v, u, v)).norm());
      std::printf("%s m=10 H=T/%d: error %.4e\n", name, n, errors.back());
    }
    EXPECT_TRUE(tests::converges_with_order(steps, errors, order, 0.15)) << name;
  }
}

/// `coupler converge`, three levels.
std::optional<int> converge(tests::CoupledRun& coupled, const std::string& over = "window") {
  return coupled.run({"converge", coupled.case_path(), "--out", coupled.out(), "--levels", "3", "--over", over});
}

TEST(Converge, ReportsTheOrder) {
  for (const auto* scheme : {"R1", "E1"}) {
    auto variant = variant_of({scheme, scheme, 40, 0, ""}, 160);
    tests::CoupledRun coupled(variant.text());
    EXPECT_EQ(converge(coupled).value_or(-1), 0) << coupled.message();
    const auto table = coupled.table();
    EXPECT_TRUE(tests::contains(table, "observed orders, window [s] 0.025, 0.0125, 0.00625")) << table;
    std::printf("%s", table.substr(table.find("observed orders")).c_str());
    EXPECT_FALSE(tests::read_text(coupled.out() + "/convergence.csv").empty());
    EXPECT_TRUE(tests::contains(tests::read_text(coupled.out() + "/convergence.gnuplot"), "seat mean pad force"));
    EXPECT_TRUE(tests::contains(table, "picture in ") || tests::contains(table, "gnuplot is not installed")) << table;
  }
}

TEST(Converge, OverSubCyclesSeesTheOrderOfTheExplicitSide) {
  tests::CoupledRun coupled(variant_of({"R1", "R1", 1, 0, ""}, 160).text());
  EXPECT_EQ(converge(coupled, "sub_cycles").value_or(-1), 0) << coupled.message();
  EXPECT_TRUE(tests::contains(coupled.table(), "observed orders, step of the sub-cycles")) << coupled.table();
}

TEST(Converge, RefusesAnOrderBelowTheSchemes) {
  // Windows that do not resolve the pad's vibration show no order.
  tests::OscillatorCase variant;
  variant.scheme = "R1", variant.window_s = end_time / 2, variant.duration_s = 2 * end_time;
  variant.largest_step_s = end_time / 640;
  variant.more_coupling = "[coupling.advisor]\naccept_unstable = true\n";
  tests::CoupledRun coupled(variant.text());
  EXPECT_EQ(converge(coupled).value_or(-1), static_cast<int>(proto::ExitCode::numerics)) << coupled.message();
  EXPECT_TRUE(tests::contains(coupled.message(), "scheme R1 should with 2")) << coupled.message();
}

TEST(InterfaceAudit, PassesR1AndFailsE1) {
  for (const auto* scheme : {"R1", "E1"}) {
    const auto defects = run({scheme, scheme, 10, 0, ""}, 1280).at("interface");
    const double energy = defects.at("energy_defect_relative"), momentum = defects.at("momentum_defect_relative");
    std::printf("%s m=10 H=T/1280: energy defect %.2e, momentum defect %.2e\n", scheme, energy, momentum);
    const bool passes = energy <= 1e-3 && momentum <= 1e-4;
    EXPECT_EQ(passes, scheme == std::string("R1"));
  }
}

TEST(InterfaceAudit, ImplicitWithTheLinearPathLosesNothingAndWithTheCubicOneEnergyAtSecondOrder) {
  const auto linear = run({"implicit", "implicit", 10, 0, to_round_off}, 320).at("interface");
  EXPECT_LT(linear.at("energy_defect_relative"), 1e-12);
  EXPECT_LT(linear.at("momentum_defect_relative"), 1e-13);
  std::vector<double> steps, defects;
  for (const int n : {160, 320, 640}) {
    const auto cubic = run({"", "implicit", 10, 0, "prolongation = \"hermite\"\n" + to_round_off}, n).at("interface");
    steps.push_back(end_time / n);
    defects.push_back(cubic.at("energy_defect_relative"));
    std::printf("hermite m=10 H=T/%d: energy defect %.2e\n", n, defects.back());
    EXPECT_GT(defects.back(), 1e-7) << "this control must see a defect";
  }
  EXPECT_TRUE(tests::converges_with_order(steps, defects, 2.0, 0.15));
}

}  // namespace
