// Schemes, advice and limits through three processes: one way from a record, what the audit does beyond its limits,
// what the advisor refuses and warns of, what a participant must offer.
#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using proto::ExitCode;

tests::OscillatorCase of_scheme(const std::string& scheme, const std::string& more = {}) {
  tests::OscillatorCase variant;
  variant.scheme = scheme;
  variant.more_coupling = more;
  return variant;
}

bool warns(const nlohmann::json& summary, const std::string& part) {
  for (const auto& warning : summary["warnings"])
    if (tests::contains(warning, part)) return true;
  return false;
}

TEST(OneWay, FromARecordTheSleeperMovesAsInTheRecordedRun) {
  tests::CoupledRun first(of_scheme("R1").text());
  ASSERT_EQ(first.run().value_or(-1), 0) << first.message();
  const auto history = first.out() + "/coupling.h5";
  tests::CoupledRun second(of_scheme("one_way", "[coupling.one_way]\nhistory = \"" + history + "\"\n").text());
  ASSERT_EQ(second.run().value_or(-1), 0) << second.message();
  EXPECT_EQ(second.participant("fem"), 0) << "a record needs no process";
  const proto::ResultReader was(history), is(second.out() + "/coupling.h5");
  for (const char* column :
       {"/seats/seat/impulse", "/seats/seat/sleeper_displacement", "/seats/seat/rail_displacement"})
    EXPECT_EQ(was.read(column).values, is.read(column).values) << column;

  auto longer = of_scheme("one_way", "[coupling.one_way]\nhistory = \"" + history + "\"\n");
  longer.duration_s = 5.0;
  tests::CoupledRun third(longer.text());
  EXPECT_EQ(third.run().value_or(-1), static_cast<int>(ExitCode::bad_data));
  EXPECT_TRUE(tests::contains(third.message(), "it ends at 4")) << third.message();
}

TEST(OneWay, LiveTheRailDoesNotHearTheSleeper) {
  std::vector<std::vector<double>> rails;
  for (const double sleeper : {-0.5, 0.8}) {
    auto variant = of_scheme("one_way", "[coupling.one_way]\nsupport_stiffness_n_per_m = [1.0, 1.0, 4.0]\n");
    variant.sleeper_displacement_m = sleeper;
    tests::CoupledRun run(variant.text());
    ASSERT_EQ(run.run().value_or(-1), 0) << run.message();
    rails.push_back(proto::ResultReader(run.out() + "/coupling.h5").read("/seats/seat/rail_displacement").values);
  }
  EXPECT_EQ(rails[0], rails[1]);
}

const std::string scales = "work_scale_j = 1.0\nimpulse_scale_n_s = 1.0\n";

TEST(AuditLimits, StopTheRun) {
  tests::CoupledRun run(of_scheme("E1", "[coupling.audit]\naction = \"stop\"\n" + scales).text());
  EXPECT_EQ(run.run().value_or(-1), static_cast<int>(ExitCode::numerics));
  EXPECT_TRUE(tests::contains(run.message(), "(coupling.audit.momentum 1.00e-04) - window ")) << run.message();
  EXPECT_LT(run.summary()["windows"], 160);
  EXPECT_GT(run.summary()["windows"], 0);
}

TEST(AuditLimits, SwitchTheScheme) {
  tests::CoupledRun run(
      of_scheme("E1", "[coupling.audit]\naction = \"switch\"\nswitch_to = \"implicit\"\n" + scales).text());
  ASSERT_EQ(run.run().value_or(-1), 0) << run.message();
  const auto summary = run.summary();
  EXPECT_EQ(summary["switched_to"], "implicit");
  EXPECT_TRUE(warns(summary, "implicit from here on"));
  const auto solves = proto::ResultReader(run.out() + "/coupling.h5").read("/solves").values;
  EXPECT_EQ(solves[1], 1.0);
  EXPECT_GE(solves.back(), 2.0);
}

TEST(AuditLimits, WarnOfWhatTheWholeRunShowed) {
  tests::CoupledRun run(of_scheme("E1").text());
  ASSERT_EQ(run.run().value_or(-1), 0) << run.message();
  EXPECT_TRUE(warns(run.summary(), "the interface's energy defect is")) << run.message();
  tests::CoupledRun silent(of_scheme("E1", "[coupling.audit]\naction = \"report\"\n").text());
  ASSERT_EQ(silent.run().value_or(-1), 0) << silent.message();
  EXPECT_TRUE(silent.summary()["warnings"].empty());
}

TEST(Resumed, EverySchemeGivesTheInterfaceOfAnUndisturbedRun) {
  const std::string switching = "[coupling.audit]\naction = \"switch\"\nswitch_to = \"implicit\"\n" + scales;
  for (const auto& [scheme, more] :
       {std::pair("implicit", std::string()), std::pair("R2", std::string()), std::pair("E0", std::string()),
        std::pair("PH", std::string()), std::pair("E1", switching)}) {
    auto variant = of_scheme(scheme, more);
    tests::CoupledRun undisturbed(variant.text());
    ASSERT_EQ(undisturbed.run().value_or(-1), 0) << undisturbed.message();
    variant.duration_s = 2.0;
    tests::CoupledRun resumed(variant.text());
    ASSERT_EQ(resumed.run().value_or(-1), 0) << resumed.message();
    variant.duration_s = 4.0;
    std::ofstream(resumed.case_path()) << variant.text();
    ASSERT_EQ(resumed.run({"run", resumed.case_path(), "--resume", resumed.out(), "--allow", "case"}).value_or(-1), 0)
        << resumed.message();
    EXPECT_EQ(resumed.summary()["resumed"], 1);
    EXPECT_EQ(resumed.summary()["interface"]["hash"], undisturbed.summary()["interface"]["hash"]) << scheme;
    EXPECT_EQ(resumed.summary()["observed"], undisturbed.summary()["observed"]) << scheme;
  }
}

TEST(Advisor, RefusesAnExplicitSchemeBeyondItsCriticalWindow) {
  auto variant = of_scheme("E1");
  variant.window_s = 0.1;
  tests::CoupledRun refused(variant.text());
  EXPECT_EQ(refused.run().value_or(-1), static_cast<int>(ExitCode::config));
  EXPECT_TRUE(
      tests::contains(refused.message(), "scheme E1 is not stable with windows of 0.1 s: on seat 'seat', normal"))
      << refused.message();
  variant.more_coupling = "[coupling.advisor]\naccept_unstable = true\n";
  tests::CoupledRun accepted(variant.text());
  EXPECT_EQ(accepted.run().value_or(-1), 0) << accepted.message();
  EXPECT_TRUE(warns(accepted.summary(), "scheme E1 is not stable"));
  EXPECT_TRUE(tests::contains(accepted.log(), "fixed-point factor")) << accepted.log();
  variant.scheme = "R1", variant.more_coupling = "";
  tests::CoupledRun robin(variant.text());
  EXPECT_EQ(robin.run().value_or(-1), 0) << robin.message();
}

TEST(Advisor, WarnsOfAPadWithoutDamping) {
  auto variant = of_scheme("R1");
  variant.pad_damping_ns_per_m = 0.0;
  tests::CoupledRun run(variant.text());
  EXPECT_EQ(run.run().value_or(-1), 0) << run.message();
  EXPECT_TRUE(warns(run.summary(), "the pad has no damping; R1 is stable for damped pads only"));
}

TEST(Advisor, WarnsWhenTheRailHasAnotherPad) {
  for (const auto& [fault, told] : {std::pair("soft_pad", true), std::pair("none", false)}) {
    auto variant = of_scheme("R1");
    variant.qdem_command = tests::relaxing_command("sleeper");
    variant.fem_command = tests::relaxing_command("rail", fault);
    tests::CoupledRun run(variant.text());
    ASSERT_EQ(run.run().value_or(-1), 0) << run.message();
    EXPECT_EQ(warns(run.summary(), "the pad of fem is 7.0 % off"), told) << run.message();
  }
}

TEST(Offers, WhatASchemeNeedsMustHaveBeenOffered) {
  const auto refusal = [](const std::string& scheme, const std::string& more) {
    auto variant = of_scheme(scheme, more);
    variant.qdem_command = tests::relaxing_command("sleeper");
    variant.fem_command = tests::relaxing_command("rail");
    tests::CoupledRun run(variant.text());
    EXPECT_EQ(run.run().value_or(-1), static_cast<int>(ExitCode::config)) << scheme;
    return run.message();
  };
  EXPECT_TRUE(tests::contains(refusal("implicit", ""), "does not offer the rollback that implicit needs"));
  EXPECT_TRUE(tests::contains(refusal("R1", "prolongation = \"hermite\"\n"),
                              "qdem does not take the field 'path_velocity_begin' that coupling.prolongation = "
                              "\"hermite\" needs"));
}

}  // namespace
