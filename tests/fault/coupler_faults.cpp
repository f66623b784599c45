// What goes wrong in a coupled run ends with one message that names the culprit, a distinct exit code, and no process
// left behind.
#include <gtest/gtest.h>

#include <chrono>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/coupled_run.hpp"

namespace {

using tests::contains;
using tests::CoupledRun;
using tests::OscillatorCase;

int code(proto::ExitCode value) {
  return static_cast<int>(value);
}

/// A case that runs until it is stopped.
OscillatorCase endless() {
  OscillatorCase variant;
  variant.duration_s = variant.window_s * 1e8;
  return variant;
}

bool all_gone(const CoupledRun& run, double limit_s) {
  const int qdem = run.participant("qdem"), fem = run.participant("fem");
  EXPECT_GT(qdem, 0);
  EXPECT_GT(fem, 0);
  return tests::becomes_true([&] { return tests::is_gone(qdem) && tests::is_gone(fem); }, limit_s);
}

/// Every window that the record says is committed is whole.
void expect_readable_record(const CoupledRun& run) {
  const proto::ResultReader record(run.out() + "/coupling.h5");
  const auto n = record.n_committed();
  const auto windows = record.read_rows("window", n).values;
  for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(windows[i], static_cast<double>(i) - 1.0);
}

class Kill : public ::testing::TestWithParam<const char*> {};

TEST_P(Kill, AParticipantIsNamedAndTheOtherEnds) {
  const std::string victim = GetParam();
  CoupledRun run(endless().text());
  run.start();
  ASSERT_TRUE(run.await_march()) << run.message();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(run.participant(victim), SIGKILL);
  EXPECT_EQ(run.wait(5.0).value_or(-1), code(proto::ExitCode::unavailable)) << run.message();
  EXPECT_TRUE(all_gone(run, 0.1));
  EXPECT_TRUE(contains(run.message(), "coupler: " + victim + " (")) << run.message();
  EXPECT_TRUE(contains(run.message(), "was killed by signal 9 (Killed) in window ")) << run.message();
  const auto summary = run.summary();
  EXPECT_EQ(summary["status"], "failed");
  EXPECT_EQ(summary["failure"]["culprit"], victim);
  EXPECT_EQ(summary["failure"]["exit_code"], 69);
  EXPECT_GT(summary["windows"], 0);
  expect_readable_record(run);
}

INSTANTIATE_TEST_SUITE_P(OfEach, Kill, ::testing::Values("qdem", "fem"));

TEST(CouplerFault, KillOfTheCouplerTakesBothParticipants) {
  CoupledRun run(endless().text());
  run.start();
  ASSERT_TRUE(run.await_march()) << run.message();
  kill(run.pid(), SIGKILL);
  EXPECT_TRUE(all_gone(run, 5.0));
  EXPECT_EQ(run.wait(1.0).value_or(-1), 128 + SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(run.out() + "/summary.json"));
  expect_readable_record(run);
}

TEST(CouplerFault, AnInterruptedRunEndsCleanly) {
  CoupledRun run(endless().text());
  run.start();
  ASSERT_TRUE(run.await_march()) << run.message();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(run.pid(), SIGINT);
  EXPECT_EQ(run.wait(5.0).value_or(-1), 128 + SIGINT) << run.message();
  EXPECT_TRUE(all_gone(run, 0.1));
  EXPECT_TRUE(contains(run.message(), "coupler: stopped by signal 2 (Interrupt) - window ")) << run.message();
  const auto summary = run.summary();
  EXPECT_EQ(summary["status"], "interrupted");
  EXPECT_EQ(summary["failure"]["culprit"], "user");
  EXPECT_TRUE(summary["oscillator"]["implicit"].contains("x")) << "the participants did not take part in the end";
  const proto::ResultReader record(run.out() + "/coupling.h5");
  EXPECT_EQ(record.n_committed(), summary["windows"].get<std::uint64_t>() + 1);
}

TEST(CouplerFault, ARunInterruptedBeforeTheFirstWindowSaysWhereAndPrintsNoTable) {
  auto variant = endless();
  variant.fem_command = R"(["sh", "-c", "sleep 1000"])";
  CoupledRun run(variant.text());
  run.start();
  ASSERT_TRUE(tests::becomes_true([&] { return run.participant("fem") > 0; }, 5.0));
  kill(run.pid(), SIGTERM);
  EXPECT_EQ(run.wait(5.0).value_or(-1), 128 + SIGTERM) << run.message();
  EXPECT_TRUE(all_gone(run, 0.1));
  EXPECT_TRUE(contains(run.message(), "coupler: stopped by signal 15 (Terminated) - start-up")) << run.message();
  EXPECT_TRUE(contains(run.table(), "no window was run")) << run.table();
  EXPECT_FALSE(contains(run.table(), "wall time")) << run.table();
  EXPECT_EQ(run.summary()["status"], "interrupted");
}

TEST(CouplerFault, AFrozenParticipantIsNamed) {
  auto variant = endless();
  variant.more_coupling = "stall_timeout_s = 1.0";
  CoupledRun run(variant.text());
  run.start();
  ASSERT_TRUE(run.await_march()) << run.message();
  kill(run.participant("fem"), SIGSTOP);
  EXPECT_EQ(run.wait(8.0).value_or(-1), code(proto::ExitCode::unavailable)) << run.message();
  EXPECT_TRUE(contains(run.message(), "fem (")) << run.message();
  EXPECT_TRUE(contains(run.message(), "hangs: its process")) << run.message();
  EXPECT_TRUE(contains(run.message(), "in window") || contains(run.message(), "- window ")) << run.message();
  EXPECT_TRUE(all_gone(run, 0.1));
}

TEST(CouplerFault, AParticipantThatNeverConnectsIsNamed) {
  OscillatorCase variant;
  variant.fem_command = R"(["sleep", "1000"])";
  variant.more_coupling = "connect_timeout_s = 0.5";
  CoupledRun run(variant.text());
  // sleep refuses the coupler's options and exits; a shell that ignores them does not.
  EXPECT_NE(run.run().value_or(-1), 0);
  variant.fem_command = R"(["sh", "-c", "sleep 1000"])";
  CoupledRun silent(variant.text());
  EXPECT_EQ(silent.run().value_or(-1), code(proto::ExitCode::unavailable));
  EXPECT_TRUE(contains(silent.message(), "fem (/")) << silent.message();
  EXPECT_TRUE(contains(silent.message(), "did not connect within")) << silent.message();
  EXPECT_TRUE(all_gone(silent, 0.1));
}

TEST(CouplerFault, AParticipantThatExitsAtOnceIsNamedWithItsLastWords) {
  OscillatorCase variant;
  variant.qdem_command = R"(["sh", "-c", "echo the bed has no stones >&2; exit 65"])";
  CoupledRun run(variant.text());
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::bad_data));
  EXPECT_TRUE(contains(run.message(), "coupler: qdem: the bed has no stones - qdem (/")) << run.message();
  EXPECT_TRUE(contains(run.message(), "exited with code 65 in start-up, before it connected")) << run.message();
  EXPECT_TRUE(all_gone(run, 0.1));
}

TEST(CouplerFault, AnExitWithoutErrorIsStillALoss) {
  OscillatorCase variant;
  variant.qdem_command = R"(["true"])";
  CoupledRun run(variant.text());
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::unavailable));
  EXPECT_TRUE(contains(run.message(), "exited with code 0")) << run.message();
}

/// The split oscillator whose rail side misbehaves.
OscillatorCase with_faulty_fem(const std::string& fault) {
  OscillatorCase variant;
  variant.qdem_command = tests::relaxing_command("sleeper");
  variant.fem_command = tests::relaxing_command("rail", fault);
  variant.more_coupling = "stall_timeout_s = 1.0";
  return variant;
}

TEST(CouplerFault, ASolverThatHangsWhileItsHeartBeatsIsNamed) {
  CoupledRun run(with_faulty_fem("hang").text());
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::unavailable)) << run.message();
  EXPECT_TRUE(contains(run.message(), "coupler: fem (")) << run.message();
  EXPECT_TRUE(contains(run.message(), "made no progress for")) << run.message();
  EXPECT_TRUE(contains(run.message(), "- window 3 -")) << run.message();
  EXPECT_TRUE(all_gone(run, 0.1));
  expect_readable_record(run);
}

TEST(CouplerFault, AnExitInTheMarchAsIfAllWereWellIsALoss) {
  CoupledRun run(with_faulty_fem("exit").text());
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::unavailable)) << run.message();
  EXPECT_TRUE(contains(run.message(), "exited with code 0 in window 3")) << run.message();
  EXPECT_TRUE(all_gone(run, 0.1));
  EXPECT_EQ(run.summary()["windows"], 3);
  expect_readable_record(run);
}

TEST(CouplerFault, ANumberThatIsNotFiniteInAMessageIsNamed) {
  CoupledRun run(with_faulty_fem("nan").text());
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::numerics)) << run.message();
  EXPECT_TRUE(contains(run.message(), "coupler: fem (")) << run.message();
  EXPECT_TRUE(contains(run.message(), "a number that is not finite was received - largest_step_s")) << run.message();
  EXPECT_TRUE(all_gone(run, 0.1));
}

TEST(CouplerFault, AnotherProtocolVersionIsTurnedAway) {
  OscillatorCase variant;
  variant.fem_command = "[\"" + std::string(HOUSE_BIN_DIR) + "/../test_bin/wrong_version_participant\"]";
  CoupledRun run(variant.text());
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::protocol));
  EXPECT_TRUE(contains(run.message(),
                       "coupler: fem: the coupler rejected this participant: it speaks protocol version "
                       "2.3, the coupler 1.3"))
      << run.message();
  EXPECT_TRUE(all_gone(run, 0.1));
}

TEST(CouplerFault, ANumberThatIsNotFiniteStopsTheRunWithItsPlace) {
  OscillatorCase variant;
  variant.initial_displacement_m = 1e308;
  CoupledRun run(variant.text());
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::numerics)) << run.message();
  EXPECT_TRUE(contains(run.message(), "not finite")) << run.message();
  EXPECT_TRUE(contains(run.message(), "rail seat 'seat', cell 0, normal")) << run.message();
  EXPECT_EQ(run.summary()["status"], "failed");
}

TEST(CouplerFault, AWrongProgramNameNamesTheKey) {
  OscillatorCase variant;
  variant.qdem_command = R"(["qdem_solvr", "participant"])";
  CoupledRun run(variant.text());
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::missing_input));
  EXPECT_TRUE(contains(run.message(), "there is no program 'qdem_solvr'")) << run.message();
  EXPECT_TRUE(contains(run.message(), "coupling.qdem_command")) << run.message();
  EXPECT_FALSE(std::filesystem::exists(run.out()));
}

TEST(CouplerFault, AnUnknownKeyNamesPlaceAndNearestKey) {
  OscillatorCase variant;
  variant.more_coupling = "stall_timeout = 3.0";
  for (const auto* command : {"run", "check"}) {
    CoupledRun run(variant.text());
    EXPECT_EQ(run.run({command, run.case_path()}).value_or(-1), code(proto::ExitCode::config));
    EXPECT_TRUE(contains(run.message(), "case.toml:7:1: coupling.stall_timeout")) << run.message();
    EXPECT_TRUE(contains(run.message(), "stall_timeout_s")) << run.message();
  }
}

TEST(CouplerFault, AnUnknownSectionNamesTheNearest) {
  CoupledRun run(OscillatorCase{}.text() + "[bedd]\nseed = 1\n");
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::config));
  EXPECT_TRUE(contains(run.message(), "did you mean 'bed'?")) << run.message();
}

TEST(CouplerFault, CheckAsksTheParticipantsToo) {
  CoupledRun good(OscillatorCase{}.text());
  EXPECT_EQ(good.run({"check", good.case_path()}).value_or(-1), 0) << good.message();
  OscillatorCase variant;
  CoupledRun bad(variant.text() + "colour = 3\n");
  EXPECT_EQ(bad.run({"check", bad.case_path()}).value_or(-1), code(proto::ExitCode::config));
  EXPECT_TRUE(contains(bad.message(), "oscillator.explicit.colour")) << bad.message();
}

TEST(CouplerFault, AMissingCaseFileIsNamed) {
  CoupledRun run("");
  EXPECT_EQ(run.run({"run", "/nowhere/case.toml"}).value_or(-1), code(proto::ExitCode::missing_input));
  EXPECT_TRUE(contains(run.message(), "/nowhere/case.toml")) << run.message();
}

TEST(CouplerFault, AWrongCommandLineIsAUsageError) {
  CoupledRun run("");
  EXPECT_EQ(run.run({"rum"}).value_or(-1), code(proto::ExitCode::usage));
  EXPECT_EQ(run.run({"run", run.case_path(), "--scheme", "R7"}).value_or(-1), code(proto::ExitCode::usage));
}

TEST(CouplerFault, AnInitialisePhaseMustBeOffered) {
  OscillatorCase variant;
  variant.more_coupling = "[coupling.initialise]\nmax_windows = 100";
  CoupledRun run(variant.text());
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::config));
  EXPECT_TRUE(contains(run.message(), "does not offer the initialise phase")) << run.message();
}

TEST(CouplerFault, TwoRunsDoNotShareAFolder) {
  CoupledRun run(endless().text());
  run.start();
  ASSERT_TRUE(run.await_march()) << run.message();
  CoupledRun second(OscillatorCase{}.text());
  EXPECT_EQ(second.run({"run", second.case_path(), "--out", run.out()}).value_or(-1),
            code(proto::ExitCode::cannot_create));
  EXPECT_TRUE(contains(second.message(), "another run is writing to this folder")) << second.message();
}

TEST(CouplerFault, AFolderThatIsNotEmptyIsRefused) {
  CoupledRun run(OscillatorCase{}.text());
  EXPECT_EQ(run.run().value_or(-1), 0) << run.message();
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::cannot_create));
  EXPECT_TRUE(contains(run.message(), "is not empty")) << run.message();
  EXPECT_EQ(run.summary()["status"], "ok") << "the first run's results were touched";
}

}  // namespace
