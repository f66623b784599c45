// A run is recorded frame by frame; each side alone is held against the record. Where its time went.
#include <gtest/gtest.h>

#include "proto/error.hpp"
#include "tests/support/coupled_run.hpp"

namespace {

using tests::contains;
using tests::CoupledRun;

const std::string broken = HOUSE_BIN_DIR "/../test_bin/broken_participant";

/// The split oscillator, recorded.
class RecordedRun : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run.run({"run", run.case_path(), "--out", run.out(), "--record"}).value_or(-1), 0) << run.message();
  }
  int replay(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"replay", run.out()});
    return run.run(arguments).value_or(-1);
  }
  std::string log() const { return run.out() + "/frames.log"; }

  CoupledRun run{tests::OscillatorCase{}.text()};
};

TEST_F(RecordedRun, EitherSideAnswersAsItDid) {
  for (const char* side : {"qdem", "fem"}) {
    EXPECT_EQ(replay({"--as", side}), 0) << run.table() << run.message();
    EXPECT_TRUE(contains(run.table(), "161 answers compared\nevery one has the record's bytes")) << run.table();
  }
}

TEST_F(RecordedRun, AnotherProgramIsToldWhereItDeparts) {
  const std::vector<std::string> command{"--", broken, "--side", "implicit", "--fault", "carry_added"};
  auto arguments = command;
  arguments.insert(arguments.begin(), {"--as", "qdem"});
  EXPECT_EQ(replay(arguments), static_cast<int>(proto::ExitCode::numerics)) << run.message();
  EXPECT_TRUE(contains(run.table(), "first difference: window ")) << run.table();
  EXPECT_TRUE(contains(run.table(), "force_used")) << run.table();
  auto explicit_side = std::vector<std::string>{"--as", "fem",    "--tolerance", "0.5",     "--",
                                                broken, "--side", "explicit",    "--fault", "none"};
  EXPECT_EQ(replay(explicit_side), 0) << run.table() << run.message();
  explicit_side[3] = "1e-9";
  EXPECT_EQ(replay(explicit_side), static_cast<int>(proto::ExitCode::numerics)) << run.table();
}

TEST_F(RecordedRun, AnAlteredRecordIsRefused) {
  auto bytes = tests::read_text(log());
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(log(), std::ios::binary) << bytes;
  EXPECT_EQ(replay({"--as", "fem"}), static_cast<int>(proto::ExitCode::bad_data));
  EXPECT_TRUE(contains(run.message(), "the record of frames ")) << run.message();
  std::filesystem::remove(log());
  EXPECT_EQ(replay({"--as", "fem"}), static_cast<int>(proto::ExitCode::missing_input)) << run.message();
}

TEST_F(RecordedRun, ATornRecordIsPlayedAsFarAsItGoes) {
  std::filesystem::resize_file(log(), std::filesystem::file_size(log()) / 2);
  EXPECT_EQ(replay({"--as", "fem"}), 0) << run.message();
  EXPECT_FALSE(contains(run.table(), "161 answers compared")) << run.table();
}

TEST_F(RecordedRun, HasAProfile) {
  ASSERT_EQ(run.run({"profile", run.out()}).value_or(-1), 0) << run.message();
  EXPECT_TRUE(contains(run.table(), "160 windows in ")) << run.table();
  const auto trace = nlohmann::json::parse(tests::read_text(run.out() + "/trace.json"), nullptr, false);
  ASSERT_TRUE(trace.is_object());
  double end = 0.0;
  int n_windows = 0;
  for (const auto& event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    const double begin = event["ts"], duration = event["dur"];
    EXPECT_GE(duration, 0.0);
    if (event["tid"] != 0) {  // a participant's computing lies within its window
      EXPECT_LE(begin + duration, end * (1 + 1e-9));
      continue;
    }
    EXPECT_GE(begin, end);
    end = begin + duration;
    ++n_windows;
  }
  EXPECT_EQ(n_windows, 160);
}

}  // namespace
