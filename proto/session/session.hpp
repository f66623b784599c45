// The participant's state machine; private to this folder.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "proto/session/participant.hpp"

namespace proto {

/// Calls the participant for each request and gives the answer, or refuses a request that is out of order.
/// The states and the legal order are those of proto/README.md.
class Session {
 public:
  Session(Participant& participant, Progress& progress);

  /// What to say first.
  Hello hello(const SessionOptions& options);

  /// Carries out one request. Returns the answer, if the request has one.
  /// Throws proto::Error (protocol) for a request out of order or of wrong shape, and whatever the participant throws.
  std::optional<Body> handle(const Body& request);

  bool finished() const { return state_ == State::finished; }
  /// The window being worked on or last worked on, -1 before the first.
  std::int64_t window() const { return window_; }

 private:
  enum class State { greeting, registered, configured, marching, advanced, finished };

  std::optional<Body> answer(const Welcome& request);
  std::optional<Body> answer(const Configure& request);
  std::optional<Body> answer(const Start& request);
  std::optional<Body> answer(const Advance& request);
  std::optional<Body> answer(const Commit& request);
  std::optional<Body> answer(const Rollback& request);
  std::optional<Body> answer(const Save& request);
  std::optional<Body> answer(const Restore& request);
  std::optional<Body> answer(const Finish& request);
  template <class Other>
  [[noreturn]] std::optional<Body> answer(const Other& request);

  [[noreturn]] void out_of_order(const char* name, const std::string& why) const;
  void require(bool condition, const char* name, const std::string& why) const;
  void check_pad(const Configure& request);
  /// Of a field: over the registered points, or over the pad's cells.
  std::size_t length_of(const std::string& name) const;
  void check_length(const std::string& name, std::size_t found, std::size_t wanted) const;
  void check_incoming(const FieldSet& data) const;
  void check_outgoing(const FieldSet& data, std::int64_t window) const;
  std::string place_of_value(std::size_t index) const;

  Participant& participant_;
  Progress& progress_;
  Capabilities capabilities_;
  Interface interface_;
  std::size_t n_values_ = 0, n_pad_values_ = 0;  ///< of the registered points and of the pad's cells
  LoadMode mode_ = LoadMode::robin;
  std::uint64_t n_windows_ = 0;

  State state_ = State::greeting;
  Phase phase_ = Phase::initialise;  ///< of the windows that come next
  std::int64_t next_window_ = 0;
  std::uint32_t next_iteration_ = 0;
  std::int64_t window_ = -1;
};

}  // namespace proto
