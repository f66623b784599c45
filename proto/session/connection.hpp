// The participant's connection to the coupler: a communication thread that owns the socket; private to this folder.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "proto/session/participant.hpp"
#include "proto/session/sockets.hpp"

namespace proto {

/// Sends and receives in the background, numbers what it sends, checks session and sequence of what it receives, sends
/// heartbeats, notices the loss of the coupler. One other thread, the computing one, uses the public functions.
class Connection {
 public:
  /// Connects; `progress` must outlive the object. Throws proto::Error (usage) for an endpoint that is none.
  Connection(const SessionOptions& options, const Progress& progress);
  /// Sends what is queued (1 s at most), then closes.
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Queues a message; returns at once.
  void send(Body body, std::uint64_t in_reply_to = 0);

  /// The next message that is meant for the state machine: never Heartbeat, Fault or Reject, never a repeated one.
  /// Throws proto::Error: unavailable when the coupler is lost, does not answer the connection, or sent a fault;
  /// protocol for a malformed message or a rejection.
  Message receive();

  /// True once receive() has thrown or would throw: the coupler is gone or has been told already.
  bool failed();

  /// The window that heartbeats report.
  void set_window(std::int64_t window);

 private:
  struct Outgoing {
    Body body;
    std::uint64_t in_reply_to = 0;
  };

  /// What tells one Advance from another.
  struct Request {
    std::uint64_t sequence = 0;
    Phase phase = Phase::march;
    std::int64_t window = 0;
    std::uint32_t iteration = 0;
  };

  void run();
  bool turn();
  void take_frames();
  void take(Message message);
  void check_order(const Message& message) const;
  bool is_repeated(const Message& message) const;
  void watch_connection();
  bool deliver(const Outgoing& outgoing);
  void deliver_queue();
  void beat();
  void fail(const Error& error);
  void leave_after_failure();
  void wake();
  std::chrono::milliseconds nap() const;

  using Clock = std::chrono::steady_clock;

  const SessionOptions options_;
  const Progress& progress_;
  const bool over_ipc_;  ///< where nobody is refused: a connection that ends lost its coupler

  // Owned by the communication thread once it runs.
  zmq::context_t context_;
  zmq::socket_t socket_;
  SocketMonitor monitor_;
  Clock::time_point connect_deadline_, next_beat_;
  std::uint64_t session_ = 0, sent_ = 0, received_ = 0;
  double heartbeat_s_ = 1.0;
  bool blocked_ = false, lost_ = false, finished_ = false;
  std::string refusal_;  ///< why the connection was not made
  std::optional<Request> last_advance_;
  std::optional<Outgoing> last_result_;

  // Shared, under the mutex.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Message> inbound_;
  std::deque<Outgoing> outbound_;
  std::optional<Error> failure_;
  bool closing_ = false;
  std::int64_t window_ = -1;

  int wake_fd_ = -1;
  std::thread thread_;
};

}  // namespace proto
