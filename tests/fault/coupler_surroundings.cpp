// What surrounds a run: the order in which participants come, impatient users, closed pipes, few descriptors, folders
// with odd names, kills while a checkpoint is written, sets of another run. The catalogue: tests/README.md "Faults".
//
// HOUSE_KILLS=500 in the environment: so many kills of the checkpoint test instead of 6.
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "proto/error.hpp"
#include "tests/support/coupled_run.hpp"

namespace {

using tests::contains;
using tests::CoupledRun;
using tests::OscillatorCase;
using Clock = std::chrono::steady_clock;

int code(proto::ExitCode value) {
  return static_cast<int>(value);
}

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Command of a side that starts `delay_s` late.
std::string delayed(const std::string& side, double delay_s) {
  return "[\"/bin/sh\", \"-c\", \"sleep " + std::to_string(delay_s) + "; exec " + tests::bin_folder +
         "/oscillator_participant participant --side " + side + " \\\"$@\\\"\", \"late\"]";
}

TEST(StartOrder, DoesNotMatter) {
  for (const auto& [qdem_s, fem_s] : {std::pair(0.0, 0.8), std::pair(0.8, 0.0), std::pair(0.5, 0.5)}) {
    OscillatorCase variant;
    variant.qdem_command = delayed("explicit", qdem_s), variant.fem_command = delayed("implicit", fem_s);
    CoupledRun run(variant.text());
    EXPECT_EQ(run.run().value_or(-1), 0) << run.message();
  }
}

TEST(StartOrder, WhoIsAbsentIsNamedAtTheTimeLimit) {
  OscillatorCase variant;
  variant.fem_command = delayed("implicit", 30.0);
  variant.more_coupling = "connect_timeout_s = 1.0\n";
  CoupledRun run(variant.text());
  const auto begin = Clock::now();
  EXPECT_EQ(run.run().value_or(-1), code(proto::ExitCode::unavailable));
  EXPECT_LT(seconds_since(begin), 5.0);
  EXPECT_TRUE(contains(run.message(), "coupler: fem (/bin/sh) did not connect within 1 s")) << run.message();
  EXPECT_EQ(run.n_processes(), 0);
}

TEST(Impatience, TheSecondInterruptDoesNotWaitForTheWindow) {
  OscillatorCase variant;
  variant.qdem_command = tests::relaxing_command("sleeper");
  variant.fem_command = tests::relaxing_command("rail", "hang");
  CoupledRun run(variant.text());
  run.start();
  ASSERT_TRUE(run.await_march()) << run.message();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  kill(run.pid(), SIGINT);
  EXPECT_FALSE(run.wait(1.0)) << "the first one waits for the window";
  const auto begin = Clock::now();
  kill(run.pid(), SIGINT);
  EXPECT_EQ(run.wait(10.0).value_or(-1), 128 + SIGINT) << run.message();
  std::printf("gone %.2f s after the second\n", seconds_since(begin));
  EXPECT_LT(seconds_since(begin), 1.0 + 0.5) << "a second, and what this machine takes";
  EXPECT_EQ(run.n_processes(), 0);
}

TEST(ClosedPipe, OfStandardOutputDoesNotEndTheRun) {
  CoupledRun run(OscillatorCase{}.text());
  const auto command = tests::bin_folder + "/coupler run " + run.case_path() + " --out " + run.out() + " | true";
  EXPECT_EQ(std::system(command.c_str()), 0);
  ASSERT_TRUE(tests::becomes_true([&] { return run.summary().is_object(); }, 20.0));
  EXPECT_EQ(run.summary()["status"], "ok");
}

TEST(FewDescriptors, AreNamedOrEnough) {
  for (const auto& [limit, enough] : {std::pair(64, true), std::pair(20, false)}) {
    CoupledRun run(OscillatorCase{}.text());
    const auto errors = run.out() + ".err";
    const auto command = "ulimit -n " + std::to_string(limit) + "; " + tests::bin_folder + "/coupler run " +
                         run.case_path() + " --out " + run.out() + " >/dev/null 2>" + errors;
    const int status = std::system(command.c_str());
    const auto text = tests::read_text(errors);
    EXPECT_EQ(status == 0, enough) << text;
    if (enough) continue;
    EXPECT_TRUE(WIFEXITED(status)) << "killed by a signal";
    EXPECT_EQ(text.find("coupler: "), 0u) << text;
    EXPECT_TRUE(contains(text, "too many open files")) << text;
    EXPECT_EQ(run.n_processes(), 0);
  }
}

TEST(SocketFolder, ALongRuntimeFolderIsNotUsed) {
  tests::TemporaryFolder folder;
  const auto deep = folder.file(std::string(120, 'd'));
  std::filesystem::create_directory(deep);
  setenv("XDG_RUNTIME_DIR", deep.c_str(), 1);
  CoupledRun run(OscillatorCase{}.text());
  EXPECT_EQ(run.run().value_or(-1), 0) << run.message();
  unsetenv("XDG_RUNTIME_DIR");
}

TEST(OddNames, OfFoldersAndCasesAreTaken) {
  tests::TemporaryFolder folder;
  const auto home = folder.file("Gleis 3 \"zwei\" \xc3\xbc\xe2\x82\xac");
  std::filesystem::create_directory(home);
  CoupledRun run("");
  const auto case_path = home + "/case.toml", out = home + "/" + std::string(200, 'o');
  std::ofstream(case_path) << OscillatorCase{}.text();
  EXPECT_EQ(run.run({"run", case_path, "--out", out}).value_or(-1), 0) << run.message();
  EXPECT_EQ(nlohmann::json::parse(tests::read_text(out + "/summary.json"))["status"], "ok");
}

TEST(Restart, WaitsLongerEveryTimeAndThenGivesUp) {
  OscillatorCase variant;
  variant.fem_command = R"(["/bin/sh", "-c", "kill -9 $$"])";
  CoupledRun run(variant.text());
  const auto begin = Clock::now();
  EXPECT_EQ(run.run({"run", run.case_path(), "--out", run.out(), "--restart", "3"}).value_or(-1),
            code(proto::ExitCode::unavailable));
  const double waited = seconds_since(begin);
  for (const char* pause : {"restart 1 of 3 in 1 s", "restart 2 of 3 in 2 s", "restart 3 of 3 in 4 s"})
    EXPECT_TRUE(contains(run.message(), pause)) << run.message();
  EXPECT_GT(waited, 7.0);
  EXPECT_LT(waited, 7.0 * 1.2 + 4.0) << "four starts are in it";
}

/// A checkpoint after every `interval` windows, of 60.
std::string saving_case(int interval, double mass_kg = 0.5) {
  OscillatorCase variant;
  variant.window_s = 1e-3, variant.duration_s = 0.06;
  variant.more_coupling = "[coupling.checkpoint]\ninterval_windows = " + std::to_string(interval) + "\n";
  auto text = variant.text();
  const std::string key = "mass_kg = 0.5";
  return text.replace(text.find(key), key.size(), "mass_kg = " + std::to_string(mass_kg));
}

std::string hash_of(const CoupledRun& run) {
  return run.summary()["interface"]["hash"];
}

TEST(CheckpointKill, WhileSetsAreWrittenLeavesOneToGoOnFrom) {
  CoupledRun whole(saving_case(1));
  ASSERT_EQ(whole.run().value_or(-1), 0) << whole.message();
  const char* asked = std::getenv("HOUSE_KILLS");
  const int n_kills = asked ? std::atoi(asked) : 6;
  std::mt19937 random(11);
  int n_resumed = 0;
  for (int i = 0; i < n_kills; ++i) {
    CoupledRun run(saving_case(1));
    run.start();
    ASSERT_TRUE(run.await_log("checkpoint after window", 20.0)) << run.message();
    std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution<int>(0, 300000)(random)));
    const char* victims[] = {"coupler", "qdem", "fem"};
    const std::string victim = victims[i % 3];
    kill(victim == "coupler" ? run.pid() : run.participant(victim), SIGKILL);
    const auto ended = run.wait(10.0).value_or(-1);
    ASSERT_TRUE(tests::becomes_true([&] { return run.n_processes() == 0; }, 10.0));
    if (ended != 0) {
      ASSERT_EQ(run.run({"run", "--resume", run.out()}).value_or(-1), 0) << "kill " << i << ": " << run.message();
      n_resumed += run.summary()["resumed"].get<int>();
    }
    EXPECT_EQ(hash_of(run), hash_of(whole)) << "kill " << i << " of " << victim;
  }
  EXPECT_GT(n_resumed, n_kills / 3);
}

TEST(CheckpointOfAnotherRun, IsRefused) {
  CoupledRun run(saving_case(60)), other(saving_case(60, 0.75));
  ASSERT_EQ(run.run().value_or(-1), 0) << run.message();
  ASSERT_EQ(other.run().value_or(-1), 0) << other.message();
  std::filesystem::remove_all(run.out() + "/checkpoint");
  std::filesystem::copy(other.out() + "/checkpoint", run.out() + "/checkpoint",
                        std::filesystem::copy_options::recursive);
  EXPECT_EQ(run.run({"run", "--resume", run.out()}).value_or(-1), code(proto::ExitCode::config));
  EXPECT_TRUE(contains(run.message(), "the checkpoint was made with another case than the folder's")) << run.message();
}

}  // namespace
