// The initialise phase through three processes: rest before time 0, and nothing moves after it.
#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/tolerance.hpp"

namespace {

/// Rail on 1 N/m with a load of -13.5 N, pad 10 N/m, sleeper on 4 N/m: f = load / (1 + kA (1/kp + 1/kB)).
constexpr double rest_force = -10.0, rest_sleeper = -2.5, rest_rail = -3.5;

tests::OscillatorCase relaxing(const std::string& scheme, int max_windows) {
  tests::OscillatorCase variant;
  variant.scheme = scheme;
  variant.qdem_command = tests::relaxing_command("sleeper");
  variant.fem_command = tests::relaxing_command("rail");
  variant.more_coupling =
      "[coupling.initialise]\nmin_windows = 30\ncheck_windows = 40\ntolerance = 1e-3\nmax_windows = " +
      std::to_string(max_windows);
  return variant;
}

class Initialise : public ::testing::TestWithParam<const char*> {};

TEST_P(Initialise, BringsTheSystemToRestAndKeepsItThere) {
  tests::CoupledRun run(relaxing(GetParam(), 5000).text());
  ASSERT_EQ(run.run().value_or(-1), 0) << run.message();
  const auto summary = run.summary();
  EXPECT_GE(summary["initialise"]["windows"], 40);
  EXPECT_LT(summary["initialise"]["windows"], 5000);
  EXPECT_LE(summary["initialise"]["change_relative"], 1e-3);
  for (const char* residual : {"qdem_residual", "fem_residual"}) {
    EXPECT_LE(summary["initialise"][residual], 5e-3) << residual;
    EXPECT_GT(summary["initialise"][residual], 0.0) << residual;
  }
  EXPECT_TRUE(tests::contains(run.log(), "at rest after")) << run.log();
  EXPECT_TRUE(tests::contains(run.log(), "residual of qdem")) << run.log();
  EXPECT_TRUE(tests::near_rel(summary["rail_seats"][0]["max_force_n"], -rest_force, 2e-3));

  const proto::ResultReader record(run.out() + "/coupling.h5");
  const auto rail = record.read("seats/seat/rail_displacement").values;
  const auto sleeper = record.read("seats/seat/sleeper_displacement").values;
  const auto impulse = record.read("seats/seat/impulse").values;
  ASSERT_EQ(record.n_committed(), 161u);
  EXPECT_EQ(record.read("window").values.front(), -1.0);
  EXPECT_TRUE(tests::near_rel(rail[2], rest_rail, 2e-3));
  EXPECT_TRUE(tests::near_rel(sleeper[2], rest_sleeper, 2e-3));
  for (std::size_t row = 1; row < record.n_committed(); ++row)
    ASSERT_TRUE(tests::near_rel(impulse[3 * row + 2] / 0.025, rest_force, 2e-3)) << "row " << row;
}

INSTANTIATE_TEST_SUITE_P(WithEach, Initialise, ::testing::Values("R1", "E1"));

TEST(InitialiseFailure, WithoutRestTheRunStopsAndSaysHowFarItWas) {
  tests::CoupledRun run(relaxing("R1", 45).text());
  EXPECT_EQ(run.run().value_or(-1), static_cast<int>(proto::ExitCode::numerics));
  for (const char* part : {"did not come to rest in 45 windows; over the last 40: ", "change of the seat force ",
                           "(tolerance 1.00e-03)", "(qdem_residual_limit 5.00e-03)", "(fem_residual_limit 5.00e-03)"})
    EXPECT_TRUE(tests::contains(run.message(), part)) << part << run.message();
  const auto summary = run.summary();
  EXPECT_EQ(summary["status"], "failed");
  EXPECT_EQ(summary["windows"], 0);
  EXPECT_GT(summary["initialise"]["change_relative"], 1e-3);
  EXPECT_GT(summary["initialise"]["qdem_residual"], 5e-3);
}

TEST(InitialiseFailure, AResidualAboveItsLimitIsNoRest) {
  for (const char* key : {"qdem_residual_limit", "fem_residual_limit"}) {
    auto variant = relaxing("R1", 1000);
    variant.more_coupling += std::string("\n") + key + " = 1e-30";
    tests::CoupledRun run(variant.text());
    EXPECT_EQ(run.run().value_or(-1), static_cast<int>(proto::ExitCode::numerics)) << key;
    EXPECT_TRUE(tests::contains(run.message(), std::string(key) + " 1.00e-30")) << run.message();
    EXPECT_LT(run.summary()["initialise"]["change_relative"], 1e-3) << key;
  }
}

TEST(InitialiseFailure, WhoOffersToInitialiseOwesAResidual) {
  for (const auto& [fault, told] : {std::pair("no_residual", "fem gave no residual"),
                                    std::pair("negative_residual", "fem gave the residual -0.5")}) {
    auto variant = relaxing("R1", 1000);
    variant.fem_command = tests::relaxing_command("rail", fault);
    tests::CoupledRun run(variant.text());
    EXPECT_EQ(run.run().value_or(-1), static_cast<int>(proto::ExitCode::protocol)) << fault;
    EXPECT_TRUE(tests::contains(run.message(), told)) << run.message();
    EXPECT_EQ(run.summary()["failure"]["culprit"], "fem") << fault;
  }
}

}  // namespace
