// A whole session between serve() and the coupler's endpoint, and each break of its rules.
#include <sys/time.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "tests/integration/session_harness.hpp"

using namespace proto;
using tests::MockParticipant;
using tests::SessionHarness;

namespace {

class Session : public SessionHarness {};

TEST_F(Session, runs_from_hello_to_bye_in_the_documented_order) {
  open();
  MockParticipant mock;
  auto served = serve_in_thread(mock, options());
  const auto hello = expect<Hello>();
  EXPECT_EQ(hello.name, "mock");
  EXPECT_EQ(hello.build_id, "mock 1");
  EXPECT_TRUE(hello.capabilities.rollback);
  EXPECT_EQ(expect<Interface>().seats.at(0).name, "seat");
  const auto configured = ask<Configured>(Configure{1e-3, 3, LoadMode::robin, "out", {}, {}, {}, {}});
  EXPECT_EQ(configured.largest_step_s.value(), 1e-6);
  EXPECT_EQ(configured.facts.at(1).text, "words");
  EXPECT_EQ(ask<Result>(window(0, 0, Phase::initialise)).residual, 0.25);
  endpoint->send("mock", Commit{0});
  EXPECT_EQ(ask<Result>(Start{}).window, -1);
  EXPECT_FALSE(ask<Result>(window(0)).residual);
  endpoint->send("mock", Rollback{0});
  const auto repeated = ask<Result>(window(0, 1));
  EXPECT_EQ(repeated.data.get("echo"), (std::vector<double>{0, 1, 1e-3}));
  endpoint->send("mock", Commit{0});
  EXPECT_EQ(ask<Saved>(Save{0, "a"}).hash, 42u);
  ask<Result>(window(1));
  endpoint->send("mock", Commit{1});
  EXPECT_EQ(ask<Restored>(Restore{0, "a", 42}).window, 0);
  EXPECT_EQ(ask<Result>(window(1)).window, 1);
  endpoint->send("mock", Commit{1});
  EXPECT_EQ(ask<Bye>(Finish{}).facts.at(0).key, "mock.end");
  EXPECT_EQ(served.get().code, 0);
  EXPECT_EQ(mock.calls,
            (std::vector<std::string>{"describe", "configure 3", "advance 0.0", "residual", "commit 0", "start",
                                      "advance 0.0", "rollback 0", "advance 0.1", "commit 0", "save a", "advance 1.0",
                                      "commit 1", "restore a", "advance 1.0", "commit 1", "finish"}));
  EXPECT_TRUE(endpoint->wait(0.3).empty()) << "leaving after Bye is no problem";
}

/// A signal every 20 us, whose handler does nothing but interrupt.
class SignalStorm {
 public:
  SignalStorm() {
    struct sigaction quiet {};
    quiet.sa_handler = [](int) {};
    sigaction(SIGALRM, &quiet, &before_);
    const itimerval often{{0, 20}, {0, 20}};
    setitimer(ITIMER_REAL, &often, nullptr);
  }
  ~SignalStorm() {
    const itimerval never{};
    setitimer(ITIMER_REAL, &never, nullptr);
    sigaction(SIGALRM, &before_, nullptr);
  }

 private:
  struct sigaction before_ {};
};

TEST_F(Session, interrupting_signals_break_nothing) {
  open();
  MockParticipant mock;
  constexpr std::int64_t n = 2000;
  auto served = serve_in_thread(mock, options());
  {
    const SignalStorm storm;
    expect<Hello>();
    expect<Interface>();
    ask<Configured>(Configure{1e-3, n, LoadMode::robin, "out", {}, {}, {}, {}});
    ask<Result>(Start{});
    for (std::int64_t i = 0; i < n; ++i) {
      ASSERT_EQ(ask<Result>(window(i)).window, i);
      endpoint->send("mock", Commit{i});
    }
    ask<Bye>(Finish{});
  }
  EXPECT_EQ(served.get().code, 0);
}

TEST_F(Session, wrong_token_is_rejected) {
  open();
  MockParticipant mock;
  auto wrong = options();
  wrong.session_token = "0000";
  auto served = serve_in_thread(mock, wrong);
  const auto event = next_event();
  EXPECT_EQ(event.participant, "");
  EXPECT_NE(event.problem.find("'mock' was rejected: the session token"), std::string::npos) << event.problem;
  const auto outcome = served.get();
  EXPECT_EQ(outcome.code, 76);
  EXPECT_NE(outcome.text.find("rejected this participant: the session token"), std::string::npos) << outcome.text;
}

TEST_F(Session, another_case_file_is_rejected_with_both_hashes) {
  open();
  MockParticipant mock;
  auto wrong = options();
  wrong.case_hash = 8;
  auto served = serve_in_thread(mock, wrong);
  EXPECT_EQ(served.wait_for(std::chrono::seconds(0)), std::future_status::timeout);
  EXPECT_NE(next_event().problem.find("0000000000000008, the coupler's 0000000000000007"), std::string::npos);
  EXPECT_EQ(served.get().code, 76);
}

TEST_F(Session, an_unexpected_name_is_rejected_with_the_nearest) {
  open();
  MockParticipant mock;
  mock.called = "mick";
  auto served = serve_in_thread(mock, options());
  EXPECT_NE(next_event().problem.find("did you mean 'mock'?"), std::string::npos);
  EXPECT_EQ(served.get().code, 76);
}

TEST_F(Session, the_second_of_a_name_is_rejected_and_the_first_goes_on) {
  open();
  MockParticipant first, second;
  auto served = serve_in_thread(first, options());
  configure();
  auto intruder = serve_in_thread(second, options());
  EXPECT_NE(next_event().problem.find("the name 'mock' is taken"), std::string::npos);
  const auto outcome = intruder.get();
  EXPECT_EQ(outcome.code, 76);
  EXPECT_LT(outcome.seconds, 2.0);
  ask<Result>(Start{});
  ask<Result>(window(0));
  endpoint->send("mock", Commit{0});
  ask<Bye>(Finish{});
  EXPECT_EQ(served.get().code, 0);
}

TEST_F(Session, a_message_out_of_order_is_answered_with_a_fault) {
  const std::vector<std::pair<Body, std::string>> breaks = {
      {window(1), "window 1 instead of 0"},
      {window(0, 1), "iteration 1 instead of 0"},
      {window(0, 0, Phase::initialise), "the initialise phase is over"},
      {Commit{0}, "that window was not advanced"},
      {Rollback{0}, "that window was not advanced"},
      {Start{}, "it ends the initialise phase"},
      {Save{3, "x"}, "only the last committed window"},
      {Configure{1e-3, 1, LoadMode::robin, "", {}, {}, {}, {}}, "it comes once"},
      {Saved{0, 1}, "a participant does not take it"},
      {Interface{}, "a participant does not take it"},
  };
  for (const auto& [message, reason] : breaks) {
    open();
    MockParticipant mock;
    auto served = serve_in_thread(mock, options());
    configure();
    ask<Result>(Start{});
    const auto fault = ask_fault(message);
    EXPECT_EQ(fault.code, 76);
    EXPECT_NE(fault.text.find(reason), std::string::npos) << fault.text;
    EXPECT_EQ(served.get().code, 76);
    pending.clear();
    endpoint.reset();
  }
}

TEST_F(Session, a_field_of_wrong_length_is_refused) {
  open();
  MockParticipant mock;
  auto served = serve_in_thread(mock, options());
  configure();
  ask<Result>(Start{});
  auto request = window(0);
  request.data.set("force_carry", {1, 2});
  EXPECT_NE(ask_fault(request).text.find("'force_carry' has 2 values, the registered cells have 3"), std::string::npos);
  EXPECT_EQ(served.get().code, 76);
}

/// One point of its own in the place of two cells.
struct OwnPoint : MockParticipant {
  Interface describe() override {
    auto interface = MockParticipant::describe();
    interface.seats[0].own_points = true;
    return interface;
  }
};

TEST_F(Session, with_points_of_its_own_the_pads_values_are_the_cells) {
  Configure request{1e-3, 10, LoadMode::robin, "out", std::vector<double>(6, 1.0), {}, {}, {}};
  for (const bool right : {true, false}) {
    open();
    OwnPoint mock;
    auto served = serve_in_thread(mock, options());
    expect<Hello>();
    expect<Interface>();
    if (right) request.pad_map = std::vector<double>(18, 0.5);
    if (!right) request.pad_map.clear();
    if (!right) {
      EXPECT_NE(ask_fault(request).text.find("points of its own gets a pad_map"), std::string::npos);
      continue;
    }
    ask<Configured>(request);
    ask<Result>(Start{});
    auto advance = window(0);
    advance.data.set(field::force_carry, std::vector<double>(6, 0.0));
    ask<Result>(advance);
    endpoint->send("mock", Commit{0});
    advance.window = 1;
    advance.data.set(field::force_carry, std::vector<double>(3, 0.0));
    EXPECT_NE(ask_fault(advance).text.find("'force_carry' has 3 values, the registered cells have 6"),
              std::string::npos);
    EXPECT_EQ(served.get().code, 76);
    pending.clear();
    endpoint.reset();
  }
}

TEST_F(Session, a_window_beyond_the_last_is_refused) {
  open();
  MockParticipant mock;
  auto served = serve_in_thread(mock, options());
  configure(1);
  ask<Result>(Start{});
  ask<Result>(window(0));
  endpoint->send("mock", Commit{0});
  EXPECT_NE(ask_fault(window(1)).text.find("all windows are done"), std::string::npos);
  EXPECT_EQ(served.get().code, 76);
}

TEST_F(Session, a_thrown_error_reaches_the_coupler_with_code_and_text) {
  open();
  MockParticipant mock;
  mock.on_commit = [](const Commit&) { throw Error(ExitCode::io_error, "the disk is full", "out/qdem.h5"); };
  auto served = serve_in_thread(mock, options());
  configure();
  ask<Result>(Start{});
  ask<Result>(window(0));
  endpoint->send("mock", Commit{0});
  const auto fault = expect<Fault>();
  EXPECT_EQ(fault.code, 74);
  EXPECT_EQ(fault.text, "the disk is full - out/qdem.h5");
  EXPECT_EQ(served.get().code, 74);
  EXPECT_EQ(next_event().problem, "the connection of 'mock' is lost");
}

TEST_F(Session, a_foreign_exception_is_an_internal_fault) {
  open();
  MockParticipant mock;
  mock.on_advance = [](const Advance&, Progress&) -> FieldSet { throw std::out_of_range("vector::at"); };
  auto served = serve_in_thread(mock, options());
  configure();
  ask<Result>(Start{});
  EXPECT_EQ(ask_fault(window(0)).code, 70);
  EXPECT_EQ(served.get().code, -1) << "rethrown as it was";
}

TEST_F(Session, a_solution_that_is_not_finite_stops_with_its_place) {
  open();
  MockParticipant mock;
  mock.on_advance = [](const Advance&, Progress&) {
    FieldSet data;
    data.set("echo", {0.0, std::nan(""), 0.0});
    return data;
  };
  auto served = serve_in_thread(mock, options());
  configure();
  ask<Result>(Start{});
  const auto fault = ask_fault(window(0));
  EXPECT_EQ(fault.code, 75);
  EXPECT_EQ(fault.text, "the solution is not finite: echo - rail seat 'seat', cell 0, lateral, window 0");
  EXPECT_EQ(served.get().code, 75);
}

TEST_F(Session, a_residual_that_is_not_finite_stops_with_the_window) {
  open();
  MockParticipant mock;
  mock.given_residual = std::nan("");
  auto served = serve_in_thread(mock, options());
  configure();
  const auto fault = ask_fault(window(0, 0, Phase::initialise));
  EXPECT_EQ(fault.code, 75);
  EXPECT_EQ(fault.text, "the residual is not finite - initialise window 0");
  EXPECT_EQ(served.get().code, 75);
}

TEST_F(Session, a_hung_solver_beats_with_a_constant_count) {
  open();
  MockParticipant mock;
  std::atomic<bool> release{false};
  mock.on_advance = [&](const Advance&, Progress& progress) {
    progress.bump();
    while (!release) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    FieldSet data;
    data.set("echo", {0, 0, 0});
    return data;
  };
  auto served = serve_in_thread(mock, options());
  configure();
  ask<Result>(Start{});
  endpoint->send("mock", window(0));
  EXPECT_TRUE(endpoint->wait(0.5).empty());
  const auto early = endpoint->pulse("mock");
  EXPECT_TRUE(endpoint->wait(1.0).empty());
  const auto late = endpoint->pulse("mock");
  EXPECT_EQ(early.progress, 1u);
  EXPECT_EQ(late.progress, 1u);
  EXPECT_EQ(late.window, 0);
  EXPECT_LT(late.silent_s, 0.5) << "it beats every 0.1 s";
  EXPECT_GT(late.progress_age_s, 1.0);
  release = true;
  expect<Result>();
  EXPECT_LT(endpoint->pulse("mock").progress_age_s, 0.5);
  endpoint->send("mock", Commit{0});
  ask<Bye>(Finish{});
  EXPECT_EQ(served.get().code, 0);
}

TEST_F(Session, a_coupler_that_goes_ends_an_idle_participant) {
  open();
  MockParticipant mock;
  auto served = serve_in_thread(mock, options());
  configure();
  endpoint.reset();
  ASSERT_EQ(served.wait_for(std::chrono::seconds(3)), std::future_status::ready);
  const auto outcome = served.get();
  EXPECT_EQ(outcome.code, 69);
  EXPECT_NE(outcome.text.find("the coupler is gone"), std::string::npos) << outcome.text;
}

TEST_F(Session, a_fault_of_the_coupler_is_what_the_participant_ends_with) {
  for (int n = 0; n < 40; ++n) {  // the fault and the loss of the connection race each other
    open_again();
    MockParticipant mock;
    auto served = serve_in_thread(mock, options());
    configure();
    endpoint->send("mock", Fault{75, "'fem' did not converge"});
    endpoint.reset();
    const auto outcome = served.get();
    EXPECT_EQ(outcome.code, 69);
    EXPECT_EQ(outcome.text, "the coupler stopped the run: 'fem' did not converge");
  }
}

TEST_F(Session, nobody_answers_at_the_endpoint) {
  MockParticipant mock;
  SessionOptions nowhere;
  nowhere.endpoint = "ipc://" + directory.path() + "/nobody";
  nowhere.connect_timeout_s = 0.5;
  auto outcome = serve_in_thread(mock, nowhere).get();
  EXPECT_EQ(outcome.code, 69);
  EXPECT_LT(outcome.seconds, 3.0);
  nowhere.endpoint = "nonsense";
  EXPECT_EQ(serve_in_thread(mock, nowhere).get().code, 64);
}

}  // namespace
