// Bad wire behaviour at either end: versions, strangers, damaged and repeated messages, floods.
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "tests/integration/raw_peer.hpp"
#include "tests/integration/session_harness.hpp"

using namespace proto;
using tests::Bytes;
using tests::MockParticipant;
using tests::RawDealer;
using tests::RawRouter;

namespace {

class Endpoint : public tests::SessionHarness {
 protected:
  void SetUp() override { open(); }

  Hello hello() const {
    return {"mock", protocol_major, protocol_minor, schema_hash(), 7, endpoint->session_token(), "", {}};
  }
  /// A dealer that was welcomed; its next message has the sequence number 2.
  std::unique_ptr<RawDealer> welcomed() {
    auto dealer = std::make_unique<RawDealer>(endpoint->address());
    dealer->send({0, 1, 0, hello()});
    expect<Hello>();
    EXPECT_EQ(std::get<Welcome>(dealer->receive().body).session, endpoint->session());
    return dealer;
  }
  void expect_problem(int code, const std::string& text) {
    const auto event = next_event();
    EXPECT_FALSE(event.message);
    EXPECT_EQ(event.participant, "mock");
    EXPECT_EQ(event.code, code);
    EXPECT_NE(event.problem.find(text), std::string::npos) << event.problem;
  }
};

TEST_F(Endpoint, another_protocol_version_is_rejected_with_both_numbers) {
  for (const auto& [major, minor] :
       {std::pair(2u, 0u), std::pair(0u, 9u), std::pair(1u, 1u), std::pair(4294967295u, 0u)}) {
    RawDealer dealer(endpoint->address());
    auto greeting = hello();
    greeting.protocol_major = major, greeting.protocol_minor = minor;
    dealer.send({0, 1, 0, greeting});
    const auto event = next_event();
    EXPECT_EQ(event.participant, "");
    const auto reason = std::get<Reject>(dealer.receive().body).reason;
    EXPECT_EQ(reason, "it speaks protocol version " + std::to_string(major) + "." + std::to_string(minor) +
                          ", the coupler 1.3");
    EXPECT_EQ(event.problem, "'mock' was rejected: " + reason);
  }
}

TEST_F(Endpoint, another_schema_is_rejected_unless_the_version_is_another) {
  auto greeting = hello();
  greeting.schema_hash ^= 1;
  RawDealer other(endpoint->address());
  other.send({0, 1, 0, greeting});
  EXPECT_NE(next_event().problem.find("its schema has the hash"), std::string::npos);
  greeting.protocol_minor = protocol_minor + 1;
  RawDealer later(endpoint->address());
  later.send({0, 1, 0, greeting});
  expect<Hello>();
}

TEST_F(Endpoint, a_participant_of_the_oldest_version_that_is_taken_is_welcome) {
  auto greeting = hello();
  greeting.schema_hash ^= 1;
  greeting.protocol_minor = oldest_protocol_minor;
  RawDealer old(endpoint->address());
  old.send({0, 1, 0, greeting});
  expect<Hello>();
}

TEST_F(Endpoint, who_does_not_begin_with_hello_is_turned_away) {
  RawDealer dealer(endpoint->address());
  dealer.send({endpoint->session(), 1, 0, Commit{0}});
  EXPECT_EQ(next_event().problem, "a stranger was rejected: the first message must be Hello, not Commit");
  dealer.send(Bytes{1, 2, 3});
  EXPECT_NE(next_event().problem.find("from a stranger: malformed frame"), std::string::npos);
}

TEST_F(Endpoint, session_and_sequence_are_checked) {
  auto dealer = welcomed();
  dealer->send({endpoint->session() + 1, 2, 0, Interface{}});
  expect_problem(76, "Interface has the session");
  dealer->send({endpoint->session(), 2, 0, Interface{}});
  EXPECT_TRUE(endpoint->wait(0.2).empty()) << "nothing of it is delivered any more";
}

TEST_F(Endpoint, a_skipped_and_a_repeated_message_are_problems) {
  auto dealer = welcomed();
  dealer->send({endpoint->session(), 3, 0, Interface{}});
  expect_problem(76, "Interface has the sequence number 3 instead of 2");
  open_again();
  dealer = welcomed();
  dealer->send({endpoint->session(), 2, 0, Interface{}});
  expect<Interface>();
  dealer->send({endpoint->session(), 2, 0, Interface{}});
  expect_problem(76, "Interface has the sequence number 2 instead of 3");
}

TEST_F(Endpoint, a_damaged_frame_is_a_problem_of_its_sender) {
  auto dealer = welcomed();
  auto frame = encode({endpoint->session(), 2, 0, Interface{}});
  frame.back() ^= 1;
  dealer->send(frame);
  expect_problem(76, "from 'mock': malformed frame: its hash");
}

TEST_F(Endpoint, a_frame_of_two_parts_is_a_problem_of_its_sender) {
  auto dealer = welcomed();
  dealer->send_two_parts(encode({endpoint->session(), 2, 0, Interface{}}));
  expect_problem(76, "a message is one frame");
}

TEST_F(Endpoint, a_number_that_is_not_finite_stops_with_the_code_of_numerics) {
  auto dealer = welcomed();
  Result result;
  result.data.set("impulse", {std::nan("")});
  dealer->send({endpoint->session(), 2, 0, result});
  expect_problem(75, "impulse[0]");
}

TEST_F(Endpoint, a_message_above_the_limit_cuts_its_sender_off) {
  auto dealer = welcomed();
  dealer->send(Bytes(2 << 20));
  expect_problem(69, "the connection of 'mock' is lost");
}

TEST_F(Endpoint, a_participant_that_vanishes_is_reported_after_its_last_message) {
  auto dealer = welcomed();
  dealer->send({endpoint->session(), 2, 0, Interface{}});
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  dealer.reset();
  expect<Interface>();
  expect_problem(69, "the connection of 'mock' is lost");
  EXPECT_THROW(endpoint->send("mock", Start{}), Error);
  EXPECT_THROW(endpoint->send("nobody", Start{}), Error);
}

TEST_F(Endpoint, another_descriptor_ends_the_wait) {
  int pipe_ends[2];
  ASSERT_EQ(pipe(pipe_ends), 0);
  ASSERT_EQ(write(pipe_ends[1], "x", 1), 1);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(endpoint->wait(5.0, pipe_ends[0]).empty());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

TEST_F(Endpoint, its_directory_is_private_short_and_removed) {
  struct stat status {};
  const auto run = directory.path() + "/run";
  ASSERT_EQ(stat(run.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700u);
  endpoint.reset();
  EXPECT_NE(stat(run.c_str(), &status), 0);
  const auto code_of = [](const std::string& path) {
    try {
      CouplerEndpoint(path, 0);
    } catch (const Error& error) {
      return static_cast<int>(error.code());
    }
    return 0;
  };
  EXPECT_EQ(code_of(directory.path() + "/" + std::string(100, 'x')), 73) << "too long for ipc";
  EXPECT_EQ(code_of(directory.path() + "/no/parent"), 73);
  ASSERT_EQ(mkdir(run.c_str(), 0755), 0);
  EXPECT_EQ(code_of(run), 73) << "open to others";
}

class Served : public tests::SessionHarness {
 protected:
  Served() : router(address()) {}
  std::string address() const { return "ipc://" + directory.path() + "/raw"; }

  void begin() {
    SessionOptions to_router;
    to_router.endpoint = address();
    to_router.connect_timeout_s = 10.0;
    served = serve_in_thread(mock, to_router);
    ASSERT_TRUE(std::holds_alternative<Hello>(router.receive().body));
    router.send({9, 1, 1, Welcome{9, 0.1}});
    ASSERT_TRUE(std::holds_alternative<Interface>(router.receive().body));
    router.send({9, 2, 0, Configure{1e-3, 3, LoadMode::robin, "", {}, {}, {}, {}}});
    ASSERT_TRUE(std::holds_alternative<Configured>(router.receive().body));
    router.send({9, 3, 0, Start{}});
    ASSERT_TRUE(std::holds_alternative<Result>(router.receive().body));
  }
  void expect_end(int code, const std::string& text) {
    const auto message = router.receive();
    ASSERT_TRUE(std::holds_alternative<Fault>(message.body)) << name_of(message.body);
    EXPECT_EQ(std::get<Fault>(message.body).code, code);
    const auto outcome = served.get();
    EXPECT_EQ(outcome.code, code);
    EXPECT_NE(outcome.text.find(text), std::string::npos) << outcome.text;
  }

  RawRouter router;
  MockParticipant mock;
  std::future<tests::Outcome> served;
};

TEST_F(Served, an_advance_sent_again_is_answered_again_without_solving) {
  begin();
  const Message request{9, 4, 0, window(0)};
  router.send(request);
  const auto first = router.receive();
  router.send(request);
  const auto again = router.receive();
  EXPECT_EQ(again.in_reply_to, 4u);
  EXPECT_GT(again.sequence, first.sequence);
  EXPECT_EQ(std::get<Result>(again.body).data.get("echo"), std::get<Result>(first.body).data.get("echo"));
  router.send({9, 5, 0, Commit{0}});
  router.send({9, 6, 0, Finish{}});
  EXPECT_TRUE(std::holds_alternative<Bye>(router.receive().body));
  EXPECT_EQ(served.get().code, 0);
  EXPECT_EQ(std::count(mock.calls.begin(), mock.calls.end(), "advance 0.0"), 1);
}

TEST_F(Served, another_window_under_the_same_number_is_no_repetition) {
  begin();
  router.send({9, 4, 0, window(0)});
  router.receive();
  router.send({9, 4, 0, window(1)});
  expect_end(76, "Advance has the sequence number 4 instead of 5");
}

TEST_F(Served, a_message_of_another_session_ends_it) {
  begin();
  router.send({8, 4, 0, window(0)});
  expect_end(76, "Advance belongs to another session");
}

TEST_F(Served, garbage_ends_it) {
  begin();
  router.send(Bytes{'Q', 'F', 'C', '1', 0, 0});
  expect_end(76, "malformed frame: shorter than its 16-byte prefix");
}

TEST(ServedDeathTest, a_computation_that_nobody_waits_for_ends_with_the_process) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto lose_the_coupler = [] {
    tests::ShortDirectory directory;
    auto endpoint = std::make_unique<CouplerEndpoint>(directory.path() + "/run", 0);
    MockParticipant mock;
    mock.on_advance = [](const Advance&, Progress&) -> FieldSet {
      while (true) pause();
    };
    SessionOptions options;
    options.endpoint = endpoint->address();
    options.session_token = endpoint->session_token();
    std::thread solver([&] { serve(mock, options); });
    endpoint->wait(5.0);
    endpoint->send("mock", Configure{1e-3, 3, LoadMode::robin, "", {}, {}, {}, {}});
    endpoint->send("mock", Start{});
    endpoint->send("mock", Advance{Phase::march, 0, 0, 1e-3, 1, {}});
    for (int n = 0; n < 3; ++n) endpoint->wait(0.5);
    endpoint.reset();
    solver.join();
  };
  EXPECT_EXIT(lose_the_coupler(), ::testing::ExitedWithCode(69),
              "the coupler is gone - ipc://.* - the computation was abandoned");
}

}  // namespace
