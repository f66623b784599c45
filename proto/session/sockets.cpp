#include "proto/session/sockets.hpp"

#include <atomic>
#include <cstring>
#include <string>

namespace proto {
namespace {

constexpr int zero_copy_receive = 10;  // ZMQ_ZERO_COPY_RECV, which zmq.h shows only to users of the draft API
constexpr int queue_length = 64;       // lock-step needs a few; a queue this long means the peer does not read
constexpr int clean_linger_ms = 1500;

constexpr int watched_events = ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_DISCONNECTED | ZMQ_EVENT_HANDSHAKE_SUCCEEDED |
                               ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL |
                               ZMQ_EVENT_HANDSHAKE_FAILED_AUTH;

std::string monitor_address() {
  static std::atomic<int> count{0};
  return "inproc://monitor-" + std::to_string(count.fetch_add(1));
}

}  // namespace

zmq::context_t make_context() {
  zmq::context_t context(1);
  context.set(zmq::ctxopt::blocky, false);
  // Received frames come in blocks of their own: an attempt, since decode() copies to aligned memory in any case.
  zmq_ctx_set(context.handle(), zero_copy_receive, 0);
  return context;
}

void set_options(zmq::socket_t& socket, const SocketSettings& settings) {
  socket.set(zmq::sockopt::linger, clean_linger_ms);
  socket.set(zmq::sockopt::rcvtimeo, 0);
  socket.set(zmq::sockopt::sndtimeo, 0);
  socket.set(zmq::sockopt::sndhwm, queue_length);
  socket.set(zmq::sockopt::rcvhwm, queue_length);
  socket.set(zmq::sockopt::maxmsgsize, settings.largest_message_bytes);
  socket.set(zmq::sockopt::handshake_ivl, 5000);
  socket.set(zmq::sockopt::heartbeat_ivl, 2000);
  socket.set(zmq::sockopt::heartbeat_timeout, settings.peer_timeout_ms);
  socket.set(zmq::sockopt::heartbeat_ttl, 15000);
}

SocketMonitor::SocketMonitor(zmq::context_t& context, zmq::socket_t& watched)
    : socket_(context, zmq::socket_type::pair) {
  const auto address = monitor_address();
  if (zmq_socket_monitor(watched.handle(), address.c_str(), watched_events) != 0) throw zmq::error_t();
  socket_.set(zmq::sockopt::linger, 0);
  socket_.connect(address);
}

std::optional<SocketMonitor::Event> SocketMonitor::next() {
  zmq::message_t head, address;
  if (!receive_part(socket_, head)) return {};
  receive_part(socket_, address);
  if (head.size() != 6) return {};
  std::uint16_t kind;
  std::uint32_t value;
  std::memcpy(&kind, head.data<char>(), sizeof kind);
  std::memcpy(&value, head.data<char>() + 2, sizeof value);
  return Event{kind, static_cast<int>(value)};
}

}  // namespace proto
