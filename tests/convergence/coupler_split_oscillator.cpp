// The split oscillator through three real processes against its closed form (test problem T2): R1, R2 and E2 are of
// second order, E1 is reported as first order, and the interface audit tells them apart.
#include "proto/error.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/oscillator_sides.hpp"
#include "tests/support/tolerance.hpp"

namespace {

constexpr double end_time = 4.0;

nlohmann::json run(const std::string& scheme, int n_windows, int sub_cycles) {
  tests::OscillatorCase variant;
  variant.scheme = scheme;
  variant.window_s = end_time / n_windows;
  variant.duration_s = end_time;
  variant.largest_step_s = variant.window_s / sub_cycles;
  tests::CoupledRun coupled(variant.text());
  EXPECT_EQ(coupled.run().value_or(-1), 0) << coupled.message();
  auto summary = coupled.summary();
  EXPECT_EQ(summary.value("status", ""), "ok");
  EXPECT_EQ(summary.value("windows", 0), n_windows);
  EXPECT_EQ(summary.value("sub_cycles", 0), sub_cycles);
  return summary;
}

double error_of(const nlohmann::json& summary) {
  const auto& sides = summary.at("oscillator");
  const Eigen::Vector4d found(sides["implicit"]["x"], sides["implicit"]["v"], sides["explicit"]["x"],
                              sides["explicit"]["v"]);
  return (found - tests::exact_state({}, end_time)).norm();
}

/// Slope over the last two halvings, all with H <= T/160.
double order(const std::string& scheme, int sub_cycles) {
  std::vector<double> steps, errors;
  for (int n : {160, 320, 640}) {
    steps.push_back(end_time / n);
    errors.push_back(error_of(run(scheme, n, sub_cycles)));
    std::printf("%s m=%d H=T/%d: error %.4e\n", scheme.c_str(), sub_cycles, n, errors.back());
  }
  const double slope = tests::fitted_order(steps, errors);
  std::printf("%s m=%d: order %.3f\n", scheme.c_str(), sub_cycles, slope);
  return slope;
}

TEST(SplitOscillator, R1IsOfSecondOrderWithoutSubCycles) {
  EXPECT_TRUE(tests::near_abs(order("R1", 1), 2.0, 0.15));
}
TEST(SplitOscillator, R1IsOfSecondOrderWithTenSubCycles) {
  EXPECT_TRUE(tests::near_abs(order("R1", 10), 2.0, 0.15));
}
TEST(SplitOscillator, R2IsOfSecondOrderWithTenSubCycles) {
  EXPECT_TRUE(tests::near_abs(order("R2", 10), 2.0, 0.15));
}
TEST(SplitOscillator, E2IsOfSecondOrderWithTenSubCycles) {
  EXPECT_TRUE(tests::near_abs(order("E2", 10), 2.0, 0.15));
}
TEST(SplitOscillator, E1IsReportedAsFirstOrderWithoutSubCycles) {
  EXPECT_TRUE(tests::near_abs(order("E1", 1), 1.0, 0.15));
}
TEST(SplitOscillator, E1IsReportedAsFirstOrderWithTenSubCycles) {
  EXPECT_TRUE(tests::near_abs(order("E1", 10), 1.0, 0.15));
}

/// `coupler converge` with windows of T/160, T/320, T/640 and the step of QDEM's side held.
std::optional<int> converge(tests::CoupledRun& coupled) {
  return coupled.run({"converge", coupled.case_path(), "--out", coupled.out(), "--levels", "3"});
}

TEST(SplitOscillator, ConvergeReportsTheOrder) {
  tests::OscillatorCase variant;
  variant.window_s = end_time / 160, variant.duration_s = end_time;
  variant.largest_step_s = variant.window_s / 40;
  for (const auto* scheme : {"R1", "E1"}) {
    variant.scheme = scheme;
    tests::CoupledRun coupled(variant.text());
    EXPECT_EQ(converge(coupled).value_or(-1), 0) << coupled.message();
    const auto table = coupled.table();
    EXPECT_TRUE(tests::contains(table, "observed orders")) << table;
    std::printf("%s", table.substr(table.find("observed orders")).c_str());
    EXPECT_FALSE(tests::read_text(coupled.out() + "/convergence.csv").empty());
  }
}

TEST(SplitOscillator, ConvergeRefusesAnOrderBelowTheSchemes) {
  // Windows that do not resolve the pad's vibration show no order.
  tests::OscillatorCase variant;
  variant.scheme = "R1", variant.window_s = end_time / 2, variant.duration_s = 2 * end_time;
  variant.largest_step_s = end_time / 640;
  tests::CoupledRun coupled(variant.text());
  EXPECT_EQ(converge(coupled).value_or(-1), static_cast<int>(proto::ExitCode::numerics)) << coupled.message();
  EXPECT_TRUE(tests::contains(coupled.message(), "scheme R1 should with 2")) << coupled.message();
}

TEST(SplitOscillator, TheAuditPassesR1AndFailsE1) {
  for (const auto* scheme : {"R1", "E1"}) {
    const auto defects = run(scheme, 1280, 10).at("interface");
    const double energy = defects.at("energy_defect_relative"), momentum = defects.at("momentum_defect_relative");
    std::printf("%s m=10 H=T/1280: energy defect %.2e, momentum defect %.2e\n", scheme, energy, momentum);
    const bool passes = energy <= 1e-3 && momentum <= 1e-4;
    EXPECT_EQ(passes, scheme == std::string("R1"));
  }
}

}  // namespace
