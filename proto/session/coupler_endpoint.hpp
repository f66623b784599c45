// The coupler's end of the wire: one ROUTER socket, its monitor, and the checks every message must pass.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proto/wire/messages.hpp"

namespace proto {

/// What happened on the wire; at most one of the two is set.
struct EndpointEvent {
  std::string participant;             ///< name after Hello was accepted, "" before
  std::optional<Message> message;
  std::string problem;                 ///< a malformed frame, an unknown sender, a lost connection: text for the fault
};

/// ROUTER bound to a fresh ipc path in `directory` (mode 0700). Not thread safe.
class CouplerEndpoint {
 public:
  /// Throws proto::Error (cannot_create) when the path is too long for ipc or cannot be bound.
  CouplerEndpoint(const std::string& directory, std::size_t largest_message_bytes);
  ~CouplerEndpoint();

  const std::string& address() const;
  /// Random per object; participants must show the token in Hello, every later message carries the session number.
  const std::string& session_token() const;
  std::uint64_t session() const;

  /// Waits until a message, a problem, readiness of `extra_fd` (if >= 0) or the time-out; empty result for the latter two.
  std::vector<EndpointEvent> wait(double timeout_s, int extra_fd = -1);

  /// Sends to a participant that has said Hello. Returns the sequence number that the answer must echo.
  /// Throws proto::Error (unavailable) naming the participant when it cannot be reached.
  std::uint64_t send(const std::string& participant, Body body);

  /// Seconds since the last frame from a participant, and the last progress count it sent.
  struct Pulse { double silent_s = 0.0; std::int64_t window = -1; std::uint64_t progress = 0; double progress_age_s = 0.0; };
  Pulse pulse(const std::string& participant) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace proto
