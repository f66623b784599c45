// Beside a run: the state of one that goes on, ended or was killed; a case to start from; a picture of a case.
#include <gtest/gtest.h>

#include "proto/error.hpp"
#include "tests/support/coupled_run.hpp"

namespace {

using tests::contains;
using tests::CoupledRun;

nlohmann::json status_of(const CoupledRun& run) {
  return nlohmann::json::parse(tests::read_text(run.out() + "/status.json"), nullptr, false);
}

/// A run of so many windows that the test ends first.
CoupledRun long_run() {
  tests::OscillatorCase text;
  text.duration_s = 1e5;
  return CoupledRun(text.text());
}

int code_of(proto::ExitCode code) {
  return static_cast<int>(code);
}

TEST(Watch, FollowsARunToItsEnd) {
  CoupledRun run(long_run()), watch("");
  run.start();
  ASSERT_TRUE(run.await_march()) << run.message();
  ASSERT_TRUE(tests::becomes_true([&] { return status_of(run).value("windows", 0) > 0; }, 20.0));
  ASSERT_EQ(watch.run({"watch", run.out(), "--once"}), 0) << watch.message();
  EXPECT_TRUE(contains(watch.table(), "running, marching")) << watch.table();
  EXPECT_TRUE(contains(watch.table(), " windows/s, ")) << watch.table();
  watch.start({"watch", run.out(), "--interval", "0.1"});
  kill(run.pid(), SIGINT);
  ASSERT_EQ(run.wait(), 128 + SIGINT) << run.message();
  EXPECT_EQ(watch.wait(), 128 + SIGINT) << "the watch returns the run's exit code";
  EXPECT_TRUE(contains(watch.table(), "interrupted")) << watch.table();
  const auto status = status_of(run);
  EXPECT_EQ(status.value("windows", 0), run.summary().value("windows", -1));
  EXPECT_NEAR(status.value("simulated_s", 0.0), 0.025 * status.value("windows", 0), 1e-9);
}

TEST(Watch, TellsAKilledRunFromOneThatGoesOn) {
  CoupledRun run(long_run()), watch("");
  run.start();
  ASSERT_TRUE(run.await_march()) << run.message();
  watch.start({"watch", run.out(), "--interval", "0.1"});
  kill(run.pid(), SIGKILL);
  EXPECT_EQ(watch.wait(), code_of(proto::ExitCode::unavailable));
  EXPECT_TRUE(contains(watch.message(), "ended without saying so")) << watch.message();
  EXPECT_TRUE(tests::becomes_true([&] { return run.n_processes() == 0; }, 20.0));
}

TEST(Watch, SaysHowAFailedRunEnded) {
  tests::OscillatorCase text;
  text.fem_command = R"(["/bin/false"])";
  CoupledRun run(text.text()), watch("");
  const auto code = run.run();
  ASSERT_NE(code.value_or(0), 0);
  EXPECT_EQ(watch.run({"watch", run.out()}), code);
  EXPECT_TRUE(contains(watch.table(), "failed")) << watch.table();
  EXPECT_EQ(watch.run({"watch", run.out() + "/none"}), code_of(proto::ExitCode::missing_input));
}

TEST(Init, MakesACaseThatIsValid) {
  CoupledRun command("");
  const tests::TemporaryFolder folder;
  const auto name = folder.file("mine");
  for (const char* from : {"wheel_passage_quick", "wheel_passage", "split_oscillator"}) {
    std::filesystem::remove_all(name);
    ASSERT_EQ(command.run({"init", name, "--from", from}), 0) << command.message();
    EXPECT_EQ(command.run({"check", name + "/case.toml"}), 0) << command.message();
  }
  EXPECT_EQ(command.run({"init", name}), code_of(proto::ExitCode::cannot_create));
  EXPECT_EQ(command.run({"init", folder.file("other"), "--from", "nothing"}), code_of(proto::ExitCode::usage));
}

TEST(Graph, DrawsTheCase) {
  tests::OscillatorCase text;
  text.scheme = "R2";
  CoupledRun command(text.text());
  const auto picture = command.out() + ".svg";
  ASSERT_EQ(command.run({"graph", command.case_path(), "--out", picture}), 0) << command.message();
  const auto source = tests::read_text(command.out() + ".dot");
  for (const char* part : {"scheme R2", "oscillator_participant", "rail seat 'seat'"})
    EXPECT_TRUE(contains(source, part)) << source;
  if (contains(command.table(), "no picture")) return;
  const auto drawn = tests::read_text(picture);
  EXPECT_TRUE(contains(drawn, "<svg") && contains(drawn, "scheme R2")) << command.table();
}

}  // namespace
