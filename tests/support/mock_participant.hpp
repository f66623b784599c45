// A participant made of functions, for tests of the session and of the coupler.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "proto/session/participant.hpp"

namespace tests {

/// One rail seat with one cell; every function can be replaced. Keeps the names of its calls in `calls`.
struct MockParticipant : proto::Participant {
  std::string called = "mock";
  proto::Capabilities can{true, true, true, true};
  std::vector<std::string> calls;

  std::function<proto::FieldSet(const proto::Advance&, proto::Progress&)> on_advance = [](const proto::Advance& request,
                                                                                          proto::Progress& progress) {
    progress.bump();
    proto::FieldSet data;
    data.set("echo", {1.0 * request.window, 1.0 * request.iteration, request.window_s});
    return data;
  };
  std::optional<double> given_residual = 0.25;
  std::function<void(const proto::Commit&)> on_commit = [](const proto::Commit&) {};

  std::string name() const override { return called; }
  std::string build_id() const override { return "mock 1"; }
  proto::Capabilities capabilities() const override { return can; }

  proto::Interface describe() override {
    calls.push_back("describe");
    proto::SeatRegistration seat;
    seat.name = "seat";
    seat.points = {0, 0, 0};
    seat.weights = {1};
    seat.rigid_response = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    seat.force_resultants = {1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
    return {{{"echo", "1", 3, true}}, {seat}};
  }
  proto::Configured configure(const proto::Configure& request) override {
    calls.push_back("configure " + std::to_string(request.windows));
    return {1e-6, {{"mock.fact", 2.5, ""}, {"mock.text", {}, "words"}}};
  }
  proto::FieldSet advance(const proto::Advance& request, proto::Progress& progress) override {
    calls.push_back("advance " + std::to_string(request.window) + "." + std::to_string(request.iteration));
    return on_advance(request, progress);
  }
  std::optional<double> residual() override {
    calls.push_back("residual");
    return given_residual;
  }
  void commit(const proto::Commit& request) override {
    calls.push_back("commit " + std::to_string(request.window));
    on_commit(request);
  }
  void rollback(const proto::Rollback& request) override {
    calls.push_back("rollback " + std::to_string(request.window));
  }
  proto::FieldSet start() override {
    calls.push_back("start");
    proto::FieldSet data;
    data.set("echo", {0, 0, 0});
    return data;
  }
  std::uint64_t save(const proto::Save& request) override {
    calls.push_back("save " + request.path);
    return 42;
  }
  void restore(const proto::Restore& request) override { calls.push_back("restore " + request.path); }
  std::vector<proto::Fact> finish() override {
    calls.push_back("finish");
    return {{"mock.end", 1.0, ""}};
  }
};

}  // namespace tests
