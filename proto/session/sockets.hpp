// ZeroMQ sockets as both ends of the wire set them up; private to this folder.
#pragma once

#include <cerrno>
#include <chrono>
#include <optional>
#include <vector>
#include <zmq.hpp>

namespace proto {

/// A context with one I/O thread that never blocks at its end for longer than its sockets' linger.
zmq::context_t make_context();

/// What differs between the two ends.
struct SocketSettings {
  int peer_timeout_ms = 10000;  ///< a peer whose I/O thread is silent for longer is disconnected
  std::int64_t largest_message_bytes = 64 << 20;
};

/// Sets every option whose default could hang, grow or lose something silently. To call before bind or connect.
void set_options(zmq::socket_t& socket, const SocketSettings& settings);

/// What `call` returns, however often a signal's handler (a child ends, say) interrupts it: libzmq gives up even a call
/// that does not wait.
template <class Call>
auto uninterrupted(Call call) {
  while (true) {
    try {
      return call();
    } catch (const zmq::error_t& error) {
      if (error.num() != EINTR) throw;
    }
  }
}

/// The next part of a message, if one is there; never blocks.
inline bool receive_part(zmq::socket_t& socket, zmq::message_t& part) {
  return uninterrupted([&] { return socket.recv(part, zmq::recv_flags::dontwait).has_value(); });
}

/// False when the socket takes nothing in its send time-out.
inline bool send_part(zmq::socket_t& socket, zmq::const_buffer part, zmq::send_flags flags) {
  return uninterrupted([&] { return socket.send(part, flags).has_value(); });
}

/// zmq::poll that takes an interrupting signal for "nothing happened".
inline void poll_sockets(std::vector<zmq::pollitem_t>& items, std::chrono::milliseconds timeout) {
  try {
    zmq::poll(items, timeout);
  } catch (const zmq::error_t& error) {
    if (error.num() != EINTR) throw;
    for (auto& item : items) item.revents = 0;
  }
}

/// Connection events of one socket.
class SocketMonitor {
 public:
  struct Event {
    int kind = 0;   ///< a ZMQ_EVENT_ constant
    int value = 0;  ///< file descriptor of the connection, or an error number
  };

  SocketMonitor(zmq::context_t& context, zmq::socket_t& watched);

  /// The oldest event not yet taken; never blocks.
  std::optional<Event> next();
  /// To poll for events.
  void* handle() { return static_cast<void*>(socket_); }

 private:
  zmq::socket_t socket_;
};

}  // namespace proto
