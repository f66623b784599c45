// A run that was interrupted goes on from its checkpoint and ends with the same bits, however it was interrupted.
//
// HOUSE_KILLS=100 in the environment: so many kills instead of 20.
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/solver_case.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::contains;
using tests::CoupledRun;

constexpr int n_windows = 1500;

int code(proto::ExitCode value) {
  return static_cast<int>(value);
}

/// Some two seconds of windows with a checkpoint after every fiftieth.
std::string oscillator_case(const std::string& checkpoint = "interval_windows = 50", int windows = n_windows) {
  tests::OscillatorCase variant;
  variant.window_s = 1e-3, variant.duration_s = windows * 1e-3;
  variant.more_coupling = "[coupling.checkpoint]\n" + checkpoint + "\n";
  return variant.text();
}

/// What must not depend on interruptions.
struct Ending {
  std::string interface_hash;
  std::uint64_t n_windows = 0;
  std::vector<double> record;  ///< a column of coupling.h5
  bool operator==(const Ending& other) const {
    return interface_hash == other.interface_hash && n_windows == other.n_windows && record == other.record;
  }
};

Ending ending_of(const CoupledRun& run) {
  const auto summary = run.summary();
  const proto::ResultReader record(run.out() + "/coupling.h5");
  return {summary["interface"]["hash"], summary["windows"],
          record.read_rows("seats/seat/momentum_defect_sum", record.n_committed()).values};
}

Ending undisturbed(const std::string& text) {
  CoupledRun run(text);
  EXPECT_EQ(run.run().value_or(-1), 0) << run.message();
  return ending_of(run);
}

std::vector<std::string> resuming(const CoupledRun& run, std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"run", "--resume", run.out()});
  return more;
}

/// Goes on until the run is complete; from its beginning where it had not come to a checkpoint.
void complete(CoupledRun& run) {
  if (run.run(resuming(run)).value_or(-1) == 0) return;
  ASSERT_TRUE(contains(run.message(), "no checkpoint to go on from")) << run.message();
  std::filesystem::remove_all(run.out());
  ASSERT_EQ(run.run().value_or(-1), 0) << run.message();
}

TEST(Resume, AfterKillsAtAnyInstantTheBitsAreTheSame) {
  const char* asked = std::getenv("HOUSE_KILLS");
  const int n_kills = asked ? std::atoi(asked) : 20;
  const auto expected = undisturbed(oscillator_case());
  ASSERT_EQ(expected.n_windows, n_windows);
  std::mt19937 random(7);
  int n_resumed = 0;
  for (int i = 0; i < n_kills; ++i) {
    CoupledRun run(oscillator_case());
    run.start();
    ASSERT_TRUE(run.await_log("started fem", 20.0)) << run.message();
    std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution<int>(0, 1500)(random)));
    const char* victims[] = {"coupler", "qdem", "fem"};
    const std::string victim = victims[i % 3];
    kill(victim == "coupler" ? run.pid() : run.participant(victim), SIGKILL);
    run.wait(10.0);
    ASSERT_TRUE(tests::becomes_true([&] { return run.n_processes() == 0; }, 10.0));
    complete(run);
    n_resumed += run.summary()["resumed"].get<int>();
    EXPECT_EQ(ending_of(run), expected) << "kill " << i << " of " << victim;
  }
  EXPECT_GT(n_resumed, n_kills / 4) << "hardly any run had come to a checkpoint";
}

TEST(Resume, GoesOnByItselfWhenAParticipantIsLost) {
  const auto expected = undisturbed(oscillator_case());
  CoupledRun run(oscillator_case());
  run.start({"run", run.case_path(), "--out", run.out(), "--restart", "3"});
  ASSERT_TRUE(run.await_log("checkpoint after window", 20.0)) << run.message();
  kill(run.participant("fem"), SIGKILL);
  EXPECT_EQ(run.wait().value_or(-1), 0) << run.message();
  EXPECT_TRUE(contains(run.message(), "restart 1 of 3 in 1 s")) << run.message();
  EXPECT_EQ(run.summary()["resumed"], 1);
  EXPECT_EQ(ending_of(run), expected);
}

TEST(Resume, RestartsEndWithTheBudget) {
  auto variant = tests::OscillatorCase{};
  variant.fem_command = R"(["/bin/sh", "-c", "kill -9 $$"])";
  CoupledRun run(variant.text());
  EXPECT_EQ(run.run({"run", run.case_path(), "--out", run.out(), "--restart", "1"}).value_or(-1),
            code(proto::ExitCode::unavailable));
  EXPECT_TRUE(contains(run.message(), "restart 1 of 1 in 1 s")) << run.message();
  EXPECT_FALSE(contains(run.message(), "restart 2")) << run.message();
}

class Stop : public ::testing::TestWithParam<int> {};

TEST_P(Stop, LeavesACheckpoint) {
  const auto expected = undisturbed(oscillator_case("interval_s = 0.0"));
  CoupledRun run(oscillator_case("interval_s = 0.0"));
  run.start();
  ASSERT_TRUE(run.await_march()) << run.message();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  kill(run.pid(), GetParam());
  EXPECT_EQ(run.wait(30.0).value_or(-1), 128 + GetParam()) << run.message();
  EXPECT_TRUE(contains(run.log(), "checkpoint after window")) << run.log();
  EXPECT_EQ(run.run(resuming(run)).value_or(-1), 0) << run.message();
  EXPECT_EQ(ending_of(run), expected);
}

INSTANTIATE_TEST_SUITE_P(By, Stop, ::testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(Resume, AfterTheLimitOfWallTime) {
  const auto text = oscillator_case("interval_s = 0.0", 5 * n_windows);
  const auto expected = undisturbed(text);
  CoupledRun run(text);
  run.start({"run", run.case_path(), "--out", run.out(), "--wall-limit", "2"});
  EXPECT_EQ(run.wait().value_or(-1), 124) << run.message();
  EXPECT_EQ(run.summary()["status"], "interrupted");
  EXPECT_EQ(run.run(resuming(run)).value_or(-1), 0) << run.message();
  EXPECT_EQ(ending_of(run), expected);
}

/// A run with checkpoints in both slots, stopped for good.
class Folder : public ::testing::Test {
 protected:
  Folder() : run(oscillator_case()) {
    run.start();
    EXPECT_TRUE(run.await_log("checkpoint after window 149", 30.0)) << run.message();
    kill(run.pid(), SIGKILL);
    run.wait(10.0);
    EXPECT_TRUE(tests::becomes_true([&] { return run.n_processes() == 0; }, 10.0));
  }
  /// The slots' folders, the newer one first.
  std::vector<std::string> slots() const {
    std::vector<std::pair<int, std::string>> found;
    for (const char* slot : {"A", "B"}) {
      const auto folder = run.out() + "/checkpoint/" + slot;
      const auto text = tests::read_text(folder + "/manifest.json");
      if (!text.empty()) found.push_back({nlohmann::json::parse(text)["window"], folder});
    }
    std::sort(found.rbegin(), found.rend());
    std::vector<std::string> folders;
    for (const auto& entry : found) folders.push_back(entry.second);
    return folders;
  }
  void rewrite(const std::string& path, const std::string& bytes) const {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  CoupledRun run;
};

TEST_F(Folder, ADamagedSetIsPassedOver) {
  const auto expected = undisturbed(oscillator_case());
  const auto both = slots();
  if (both.size() < 2) GTEST_SKIP() << "NOT RUN: killed in the middle of a checkpoint";
  const auto file = both[0] + "/fem.h5";
  auto bytes = tests::read_text(file);
  bytes[bytes.size() / 2] ^= 1;
  rewrite(file, bytes);
  EXPECT_EQ(run.run(resuming(run)).value_or(-1), 0) << run.message();
  EXPECT_TRUE(contains(run.message(), file + " is missing or damaged")) << run.message();
  EXPECT_EQ(ending_of(run), expected);
}

TEST_F(Folder, NothingUsableIsSaid) {
  std::mt19937 random(3);
  for (const auto& slot : slots()) {
    const auto file = slot + "/qdem.h5";
    std::filesystem::resize_file(file, random() % std::filesystem::file_size(file));
  }
  EXPECT_EQ(run.run(resuming(run)).value_or(-1), code(proto::ExitCode::missing_input));
  EXPECT_TRUE(contains(run.message(), "there is no checkpoint to go on from")) << run.message();
}

TEST_F(Folder, AChangedCaseIsRefusedWithWhatDiffers) {
  auto text = tests::read_text(run.case_path());
  text.replace(text.find("mass_kg = 0.5"), 13, "mass_kg = 0.6");
  rewrite(run.case_path(), text);
  EXPECT_EQ(run.run(resuming(run)).value_or(-1), code(proto::ExitCode::config));
  EXPECT_TRUE(contains(run.message(), "oscillator.explicit.mass_kg: 0.5 -> 0.6")) << run.message();
  EXPECT_EQ(run.run(resuming(run, {"--allow", "case"})).value_or(-1), 0) << run.message();
}

TEST_F(Folder, ALongerCaseGoesOn) {
  auto text = tests::read_text(run.case_path());
  const std::string key = "duration_s = 1.5";
  ASSERT_NE(text.find(key), std::string::npos) << text;
  text.replace(text.find(key), key.size(), "duration_s = 1.6");
  rewrite(run.case_path(), text);
  EXPECT_EQ(run.run(resuming(run, {"--allow", "case"})).value_or(-1), 0) << run.message();
  EXPECT_EQ(ending_of(run), undisturbed(text));
}

TEST_F(Folder, OtherWindowsAreRefused) {
  auto text = tests::read_text(run.case_path());
  const std::string key = "window_s = 0.001";
  ASSERT_NE(text.find(key), std::string::npos) << text;
  text.replace(text.find(key), key.size(), "window_s = 0.0005");
  rewrite(run.case_path(), text);
  EXPECT_EQ(run.run(resuming(run, {"--allow", "case"})).value_or(-1), code(proto::ExitCode::config));
  EXPECT_TRUE(contains(run.message(), "run the changed case from its beginning")) << run.message();
}

TEST_F(Folder, AnotherVersionIsRefused) {
  for (const auto& slot : slots()) {
    auto manifest = nlohmann::json::parse(tests::read_text(slot + "/manifest.json"));
    manifest["version"] = "0.0.1";
    rewrite(slot + "/manifest.json", manifest.dump());
  }
  EXPECT_EQ(run.run(resuming(run)).value_or(-1), code(proto::ExitCode::config));
  EXPECT_TRUE(contains(run.message(), "made by another version of the program: 0.0.1")) << run.message();
  EXPECT_EQ(run.run(resuming(run, {"--allow", "version"})).value_or(-1), 0) << run.message();
}

TEST(Resume, AFolderWithoutARunIsRefused) {
  tests::TemporaryFolder folder;
  CoupledRun run(oscillator_case());
  EXPECT_EQ(run.run({"run", "--resume", folder.path()}).value_or(-1), code(proto::ExitCode::missing_input));
  EXPECT_EQ(run.run({"run", "--resume", folder.file("none")}).value_or(-1), code(proto::ExitCode::missing_input));
  EXPECT_TRUE(contains(run.message(), "there is no folder of a run")) << run.message();
}

/// A script that is started as `PROGRAM participant ...` and becomes `command`.
std::string stand_in(const tests::TemporaryFolder& folder, const std::string& command) {
  const auto path = folder.file("stand_in");
  std::ofstream(path) << "#!/bin/sh\nshift\nexec " << command << " \"$@\"\n";
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

const std::string implicit_side = " participant --side implicit";
const std::string other_program = std::string(HOUSE_BIN_DIR) + "/../test_bin/broken_participant";

TEST_F(Folder, TheSameProgramFromElsewhereTakesOverToTheBit) {
  const auto expected = undisturbed(oscillator_case());
  tests::TemporaryFolder elsewhere;
  const auto copy = elsewhere.file("rail_of_mine");
  std::filesystem::copy_file(tests::bin_folder + "/oscillator_participant", copy);
  EXPECT_EQ(run.run(resuming(run, {"--fem", stand_in(elsewhere, copy + implicit_side)})).value_or(-1), 0)
      << run.message();
  EXPECT_TRUE(contains(run.log(), "started fem: " + elsewhere.file("stand_in"))) << run.log();
  EXPECT_EQ(ending_of(run), expected);
}

TEST_F(Folder, AnotherProgramTakesOverWhenThatIsAllowed) {
  const auto expected = undisturbed(oscillator_case());
  tests::TemporaryFolder elsewhere;
  const std::vector<std::string> other{"--fem", stand_in(elsewhere, other_program + " --side implicit --fault none")};
  EXPECT_EQ(run.run(resuming(run, other)).value_or(-1), code(proto::ExitCode::config));
  EXPECT_TRUE(contains(run.message(), "the state of another fem: 'oscillator_participant', this is ''"))
      << run.message();
  auto allowed = other;
  allowed.insert(allowed.end(), {"--allow", "program"});
  ASSERT_EQ(run.run(resuming(run, allowed)).value_or(-1), 0) << run.message();
  // The same model: it went on from the state, not from its beginning.
  const auto is = ending_of(run).record;
  ASSERT_EQ(is.size(), expected.record.size());
  EXPECT_TRUE(tests::near_abs(is.back(), expected.record.back(), 1e-9));
}

TEST(HotSwap, AStateOfAnotherFormIsRefused) {
  tests::OscillatorCase variant;
  variant.fem_command = "[\"" + other_program + "\", \"--side\", \"implicit\", \"--fault\", \"none\"]";
  CoupledRun run(variant.text());
  ASSERT_EQ(run.run().value_or(-1), 0) << run.message();
  variant.duration_s = 5.0;
  std::ofstream(run.case_path()) << variant.text();
  tests::TemporaryFolder elsewhere;
  const auto program = stand_in(elsewhere, tests::bin_folder + "/oscillator_participant" + implicit_side);
  EXPECT_EQ(run.run(resuming(run, {"--fem", program, "--allow", "case,program"})).value_or(-1),
            code(proto::ExitCode::bad_data));
  EXPECT_TRUE(contains(run.message(), "coupler: fem: ")) << run.message();
  EXPECT_TRUE(contains(run.message(), "fem.h5")) << run.message();
}

TEST(Resume, WarningsOfTheFirstPartAreKept) {
  tests::OscillatorCase variant;
  variant.scheme = "E1";
  variant.more_coupling =
      "[coupling.audit]\naction = \"switch\"\nswitch_to = \"implicit\"\nwork_scale_j = 1.0\n"
      "impulse_scale_n_s = 1.0\n";
  CoupledRun run(variant.text());
  ASSERT_EQ(run.run().value_or(-1), 0) << run.message();
  const auto before = run.summary()["warnings"];
  ASSERT_FALSE(before.empty());
  variant.duration_s = 5.0;
  std::ofstream(run.case_path()) << variant.text();
  ASSERT_EQ(run.run(resuming(run, {"--allow", "case"})).value_or(-1), 0) << run.message();
  EXPECT_EQ(run.summary()["warnings"], before);
}

/// Stones, rail and wheel for 300 windows, with everything that is recorded.
std::string real_case() {
  return tests::solver_case({{"duration_s", "0.03"}, {"speed_m_per_s", "2.0"}, {"threads", "0"}}) +
         "\n[coupling.checkpoint]\ninterval_windows = 40\n"
         "[[qdem.sensor]]\nname = \"stone\"\nkind = \"stone\"\npoint_m = [0.0, 0.1, -0.15]\n";
}

std::vector<double> column(const CoupledRun& run, const std::string& file, const std::string& name) {
  return proto::ResultReader(run.out() + "/" + file).read(name).values;
}

TEST(ResumeOfTheSolvers, GivesTheSameStateAndRecords) {
  setenv("QDEM_BED_CACHE", HOUSE_BIN_DIR "/../test_beds", 1);
  auto text = real_case();
  text.replace(text.find("[qdem]\n"), 7, "[qdem]\nsensor_interval_s = 2e-4\ncontact_output = true\n");
  CoupledRun whole(text), broken(text);
  whole.start({"run", whole.case_path(), "--out", whole.out(), "--threads", "1"});
  ASSERT_EQ(whole.wait(200.0).value_or(-1), 0) << whole.message();
  broken.start({"run", broken.case_path(), "--out", broken.out(), "--threads", "1"});
  ASSERT_TRUE(broken.await_log("checkpoint after window 79", 200.0)) << broken.message();
  kill(broken.participant("qdem"), SIGKILL);
  ASSERT_EQ(broken.wait(10.0).value_or(-1), code(proto::ExitCode::unavailable));
  broken.start(resuming(broken, {"--threads", "2"}));
  ASSERT_EQ(broken.wait(200.0).value_or(-1), 0) << broken.message();
  const auto a = whole.summary(), b = broken.summary();
  EXPECT_EQ(b["resumed"], 1);
  EXPECT_EQ(a["interface"]["hash"], b["interface"]["hash"]);
  EXPECT_EQ(a["qdem"]["end"]["state_hash"], b["qdem"]["end"]["state_hash"]);
  EXPECT_EQ(a["fem"]["end"]["state_hash"], b["fem"]["end"]["state_hash"]);
  for (const char* name : {"/VTKHDF/PointData/displacement", "/VTKHDF/CellData/von_mises_stress",
                           "/VTKHDF/Steps/Values", "/VTKHDF/Points", "/TimeSeries/kinetic_energy"})
    EXPECT_EQ(column(whole, "qdem.h5", name), column(broken, "qdem.h5", name)) << name;
  for (const char* name : {"/VTKHDF/PointData/velocity", "/TimeSeries/wheel/contact_force"})
    EXPECT_EQ(column(whole, "fem.h5", name), column(broken, "fem.h5", name)) << name;
  EXPECT_EQ(column(whole, "contacts.h5", "force"), column(broken, "contacts.h5", "force"));
  EXPECT_EQ(column(whole, "sensors.h5", "stone/acceleration"), column(broken, "sensors.h5", "stone/acceleration"));
}

}  // namespace
