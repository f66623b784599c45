// The conformance suite: participants that keep the protocol pass it, each of those that break one rule is caught by
// the check that is meant for it.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "tests/support/coupled_run.hpp"
#include "tests/support/solver_case.hpp"

namespace {

using tests::CoupledRun;

/// `coupler conformance` for one participant; the exit code. `report` is what it wrote.
int run_suite(CoupledRun& run, std::vector<std::string> options, const std::vector<std::string>& command,
              nlohmann::json& report) {
  const auto json = run.out() + ".json";
  std::vector<std::string> arguments{"conformance", "--case", run.case_path(), "--json", json};
  arguments.insert(arguments.end(), options.begin(), options.end());
  arguments.emplace_back("--");
  arguments.insert(arguments.end(), command.begin(), command.end());
  run.start(arguments);
  const int code = run.wait(120.0).value_or(-1);
  report = nlohmann::json::parse(tests::read_text(json), nullptr, false);
  return code;
}

/// A participant that has to pass.
struct Conforming {
  std::string title, role, case_text;
  std::vector<std::string> command;
  std::size_t n_not_offered;  ///< checks of what it does not offer
  friend void PrintTo(const Conforming& participant, std::ostream* out) { *out << participant.title; }
};

const std::string broken = HOUSE_BIN_DIR "/../test_bin/broken_participant";

/// One line for each participant of the house.
std::vector<Conforming> participants() {
  const auto oscillator = tests::OscillatorCase{}.text();
  return {
      {"oscillator_explicit", "qdem", oscillator, {"oscillator_participant", "participant", "--side", "explicit"}, 1},
      {"oscillator_implicit", "fem", oscillator, {"oscillator_participant", "participant", "--side", "implicit"}, 1},
      {"control_explicit", "qdem", oscillator, {broken, "--side", "explicit", "--fault", "none"}, 1},
      {"control_implicit", "fem", oscillator, {broken, "--side", "implicit", "--fault", "none"}, 1},
      {"qdem_solver", "qdem", tests::solver_case(), {"qdem_solver", "participant"}, 0},
      {"fem_solver", "fem", tests::solver_case(), {"fem_solver", "participant"}, 0},
      {"fem_beam", "fem", tests::solver_case({{"n_bays", "10"}}), {"fem_beam", "participant"}, 0},
      {"python", "fem", oscillator, {HOUSE_BIN_DIR "/../test_bin/spring_rail/spring_rail.py", "participant"}, 2}};
}

class Conformance : public ::testing::TestWithParam<Conforming> {};

TEST_P(Conformance, IsReached) {
  setenv("QDEM_BED_CACHE", HOUSE_BIN_DIR "/../test_beds", 1);
  const auto& participant = GetParam();
  if (participant.title == "python" &&
      std::system("/usr/bin/python3 -c 'import flatbuffers, xxhash, zmq' 2>/dev/null") != 0)
    GTEST_SKIP() << "NOT RUN: /usr/bin/python3 lacks flatbuffers, xxhash or zmq";
  CoupledRun run(participant.case_text);
  nlohmann::json report;
  EXPECT_EQ(run_suite(run, {"--name", participant.role}, participant.command, report), 0)
      << run.table() << run.message();
  ASSERT_TRUE(report.is_object());
  EXPECT_EQ(report["conforms"], true);
  EXPECT_EQ(report["participant"], participant.role);
  std::size_t n_not_offered = 0;
  for (const auto& check : report["checks"]) n_not_offered += check["outcome"] == "not offered";
  EXPECT_EQ(n_not_offered, participant.n_not_offered);
  EXPECT_EQ(report["checks"].size(), participant.role == "qdem" ? 23u : 24u);
  EXPECT_EQ(run.n_processes(), 0);
}

INSTANTIATE_TEST_SUITE_P(By, Conformance, ::testing::ValuesIn(participants()),
                         [](const auto& test) { return test.param.title; });

/// A broken rule and the check that has to see it.
struct Fault {
  const char* name;
  const char* check;
  const char* side = "explicit";
  friend void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }
};

const Fault faults[] = {{"wrong_name", "handshake"},
                        {"stays_when_rejected", "rejection"},
                        {"wrong_unit", "units_and_shapes"},
                        {"short_field", "units_and_shapes"},
                        {"bent_operator", "rigid_motion"},
                        {"no_residual", "initialise"},
                        {"end_force", "impulse"},
                        {"carry_added", "robin_law", "implicit"},
                        {"wrong_way", "momentum", "implicit"},
                        {"nudged", "sub_cycles"},
                        {"strict_fields", "unknown_field"},
                        {"unseeded", "repeatable"},
                        {"forgets_answers", "repeated_request"},
                        {"no_rollback", "rollback"},
                        {"half_a_state", "save_restore"},
                        {"any_order", "bad_order"},
                        {"takes_nan", "bad_values"},
                        {"any_length", "bad_length"},
                        {"crashes_on_damage", "bad_bytes"},
                        {"any_session", "bad_session"},
                        {"any_size", "oversize"},
                        {"no_heartbeats", "heartbeats"},
                        {"no_progress", "heartbeats"},
                        {"fails_at_the_end", "farewell"},
                        {"deaf_to_faults", "abort"},
                        {"stays_alone", "lost_coupler"},
                        {"leaves_a_child", "kill"}};

class BrokenParticipant : public ::testing::TestWithParam<Fault> {};

TEST_P(BrokenParticipant, IsCaught) {
  const auto& fault = GetParam();
  tests::OscillatorCase oscillator;
  oscillator.more_coupling = "connect_timeout_s = 3.0\n";
  CoupledRun run(oscillator.text());
  nlohmann::json report;
  const std::string role = fault.side == std::string("explicit") ? "qdem" : "fem";
  const int code = run_suite(run, {"--name", role, "--only", fault.check, "--out", run.out()},
                             {broken, "--side", fault.side, "--fault", fault.name}, report);
  EXPECT_EQ(code, 76) << run.table() << run.message();
  ASSERT_TRUE(report.is_object());
  ASSERT_EQ(report["checks"].size(), 1u);
  EXPECT_EQ(report["checks"][0]["outcome"], "fail");
  EXPECT_EQ(report["checks"][0]["name"], fault.check);
  std::printf("%s\n", report["checks"][0]["reason"].get<std::string>().c_str());
  EXPECT_EQ(run.n_processes(), 0);
}

INSTANTIATE_TEST_SUITE_P(With, BrokenParticipant, ::testing::ValuesIn(faults),
                         [](const auto& test) { return test.param.name; });

}  // namespace
