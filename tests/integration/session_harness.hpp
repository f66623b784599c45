// A coupler's endpoint and participants' threads in one process.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <string>

#include "proto/session/coupler_endpoint.hpp"
#include "proto/session/participant.hpp"
#include "tests/support/mock_participant.hpp"

namespace tests {

/// A fresh directory below /tmp, removed at the end.
class ShortDirectory {
 public:
  ShortDirectory() {
    char name[] = "/tmp/qf-test-XXXXXX";
    path_ = mkdtemp(name);
  }
  ~ShortDirectory() { std::filesystem::remove_all(path_); }
  std::string path() const { return path_; }

 private:
  std::string path_;
};

/// What serve() ended with.
struct Outcome {
  int code = 0;
  std::string text;
  double seconds = 0.0;
};

class SessionHarness : public ::testing::Test {
 protected:
  void open(proto::Admission admission = {{"mock"}, 7, 0.1}) {
    endpoint = std::make_unique<proto::CouplerEndpoint>(directory.path() + "/run", 1 << 20, admission);
  }

  /// Another run in the same place.
  void open_again() {
    endpoint.reset();
    pending.clear();
    open();
  }

  proto::SessionOptions options() const {
    proto::SessionOptions result;
    result.endpoint = endpoint->address();
    result.session_token = endpoint->session_token();
    result.case_hash = 7;
    result.connect_timeout_s = 10.0;
    return result;
  }

  /// serve() in a thread of its own.
  static std::future<Outcome> serve_in_thread(proto::Participant& participant, const proto::SessionOptions& options) {
    return std::async(std::launch::async, [&participant, options] {
      const auto begin = std::chrono::steady_clock::now();
      Outcome outcome;
      try {
        proto::serve(participant, options);
      } catch (const proto::Error& error) {
        outcome = {static_cast<int>(error.code()), error.what()};
      } catch (const std::exception& error) {
        outcome = {-1, error.what()};
      }
      outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      return outcome;
    });
  }

  /// The next event, in at most 10 s.
  proto::EndpointEvent next_event() {
    if (pending.empty()) pending = endpoint->wait(10.0);
    if (pending.empty()) {
      ADD_FAILURE() << "nothing came in 10 s";
      return {};
    }
    auto event = std::move(pending.front());
    pending.erase(pending.begin());
    return event;
  }

  /// The next event, which must be a message of this type.
  template <class Body>
  Body expect() {
    auto event = next_event();
    if (!event.message || !std::holds_alternative<Body>(event.message->body)) {
      ADD_FAILURE() << "expected " << proto::name_of(Body{}) << ", found "
                    << (event.message ? proto::name_of(event.message->body) : event.problem);
      return {};
    }
    last_reply = event.message->in_reply_to;
    return std::get<Body>(std::move(event.message->body));
  }

  /// Sends a request and takes its answer.
  template <class Answer>
  Answer ask(proto::Body request) {
    const auto sequence = endpoint->send("mock", std::move(request));
    const auto answer = expect<Answer>();
    EXPECT_EQ(last_reply, sequence);
    return answer;
  }

  /// Sends something that the participant must answer with a fault.
  proto::Fault ask_fault(proto::Body request) {
    endpoint->send("mock", std::move(request));
    return expect<proto::Fault>();
  }

  /// Handshake up to the configured state.
  void configure(std::uint64_t windows = 10) {
    expect<proto::Hello>();
    expect<proto::Interface>();
    ask<proto::Configured>(proto::Configure{1e-3, windows, proto::LoadMode::robin, "out", {}, {}, {}, {}});
  }

  static proto::Advance window(std::int64_t number, std::uint32_t iteration = 0,
                               proto::Phase phase = proto::Phase::march) {
    return {phase, number, iteration, 1e-3, 4, {}};
  }

  ShortDirectory directory;
  std::unique_ptr<proto::CouplerEndpoint> endpoint;
  std::vector<proto::EndpointEvent> pending;
  std::uint64_t last_reply = 0;
};

}  // namespace tests
