// The coupler's end of the wire: one ROUTER socket, its monitor, and the checks every message must pass.
//
// The endpoint does the handshake by itself: a Hello that shows the token, the right protocol version, the schema's and
// the case's hash and an expected, unused name is answered with Welcome; any other with Reject and its reason. Messages
// that pass are numbered per participant from 1 without gaps and carry the session; one that does not is a problem of
// that participant, and nothing it sends afterwards is delivered.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proto/session/door.hpp"
#include "proto/span.hpp"
#include "proto/wire/messages.hpp"

namespace proto {

/// What happened on the wire; exactly one of message and problem is set.
///
/// participant set, message: one message of that participant. The first is its Hello, already answered with Welcome;
///     Heartbeats are not delivered (see pulse()). What answers what is for the caller to check (`in_reply_to`).
/// participant set, problem: that participant is lost to the session: its connection is gone, or it sent a malformed
///     frame (also: numbers that are not finite), a wrong session or a wrong sequence number. `code` says which exit
///     code fits: unavailable, protocol, numerics.
/// participant empty, problem: somebody not admitted was turned away; the participants are undisturbed. A caller that
///     started the rejected program sees it exit with code 76.
struct EndpointEvent {
  std::string participant;
  std::optional<Message> message;
  std::string problem;
  int code = 0;
};

/// Whom the endpoint welcomes.
struct Admission {
  std::vector<std::string> names;  ///< the expected participants; empty: any name, each once
  std::uint64_t case_hash = 0;     ///< CaseFile::hash(); 0: not compared
  double heartbeat_s = 1.0;        ///< interval that participants are told
};

/// ROUTER bound to an ipc path in `directory`, and to a door's address. Not thread safe: one thread uses it.
class CouplerEndpoint {
 public:
  /// Binds `directory`/coupler. The directory is created with mode 0700 (its parent must exist); one that exists must
  /// belong to this user with mode 0700. It must be short: the socket's path has to stay below 108 bytes.
  /// `largest_message_bytes` (at least 1 MiB is used): a sender of more is cut off.
  /// Through a door with a key come only connections encrypted by CURVE whose key is allowed; such a participant must
  /// have the name of its key. An ipc connection needs none: the directory's mode says who may.
  /// Throws proto::Error (cannot_create) when the path is too long or an address cannot be bound.
  CouplerEndpoint(const std::string& directory, std::size_t largest_message_bytes, Admission admission = {},
                  const Door& door = {});
  /// Gives messages already sent up to 1.5 s to leave, closes, removes the socket file and a directory it created.
  ~CouplerEndpoint();

  /// "ipc://..." for the participants' command line.
  const std::string& address() const;
  /// "tcp://HOST:PORT" of the door; "" without.
  const std::string& door_address() const;
  /// Random per object; participants must show the token in Hello, every later message carries the session number.
  const std::string& session_token() const;
  std::uint64_t session() const;

  /// Waits until a message, a problem, readiness of `extra_fd` (if >= 0) or the time-out; empty result for the latter
  /// two. Events come in the order of the wire; a participant's last messages before its loss.
  std::vector<EndpointEvent> wait(double timeout_s, int extra_fd = -1);

  /// Sends to a participant that has said Hello. Returns the sequence number that the answer must echo.
  /// Throws proto::Error (unavailable) naming the participant when it cannot be reached.
  std::uint64_t send(const std::string& participant, Body body);

  /// Sends `frame` as it is, neither numbered nor counted: what a participant has to refuse, for a test of it.
  /// Throws as send().
  void send_bytes(const std::string& participant, Span<const std::uint8_t> frame);

  /// Is told of every frame that is exchanged after the handshake, heartbeats included: with whom, whether it was sent.
  using Observer = std::function<void(const std::string&, bool sent, Span<const std::uint8_t>)>;
  void observe(Observer observer);

  /// Signs of life of a participant that has said Hello; zeros for any other.
  struct Pulse {
    double silent_s = 0.0;        ///< since its last frame
    std::int64_t window = -1;     ///< that it says it works on
    std::uint64_t progress = 0;   ///< last work count of its heartbeats
    double progress_age_s = 0.0;  ///< since the count last changed or send() gave it something to do
  };
  /// As of the last wait(): while nobody waits nothing is read, so judge a pulse only after wait().
  Pulse pulse(const std::string& participant) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace proto
