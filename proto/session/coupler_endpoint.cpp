#include "proto/session/coupler_endpoint.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include "proto/clock.hpp"
#include "proto/error.hpp"
#include "proto/session/gatekeeper.hpp"
#include "proto/session/handshake.hpp"
#include "proto/session/run_directory.hpp"
#include "proto/session/sockets.hpp"
#include "proto/wire/codec.hpp"

namespace proto {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t smallest_limit = 1 << 20;
constexpr int send_timeout_ms = 5000;
constexpr int most_frames_at_once = 256;  // so that wait() returns from a flood

/// One connection that was welcomed.
struct Peer {
  std::string name;
  std::string routing_id;
  int fd = -1;  ///< of the connection, to recognise the monitor's events
  std::uint64_t received = 0, sent = 0;
  bool broken = false;    ///< a problem was reported; nothing more is delivered
  bool finished = false;  ///< said Bye: may close the connection
  Clock::time_point last_frame = Clock::now(), last_change = last_frame;
  Heartbeat beat{-1, 0};
};

/// The name that goes with the key of the connection a frame came by; "" without a key.
std::string key_name(zmq::message_t& frame) {
  const char* name = zmq_msg_gets(frame.handle(), "User-Id");
  return name ? name : "";
}

/// What a connection that was given up before its first message lacked.
std::string failure_in_words(const SocketMonitor::Event& event) {
  if (event.kind != ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL) return "it ended in its handshake, as one without a key does";
  if (event.value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH) return "it shows no key";
  if (event.value == ZMQ_PROTOCOL_ERROR_ZMTP_CRYPTOGRAPHIC) return "it was made for another coupler's key";
  return "it does not speak the protocol";
}

/// File descriptor of the connection a frame came by, or -1.
int connection_of(zmq::message_t& frame) {
  return zmq_msg_get(frame.handle(), ZMQ_SRCFD);
}

}  // namespace

struct CouplerEndpoint::Data {
  Data(const std::string& directory, std::size_t largest_message_bytes, Admission who, const Door& door)
      : admission(std::move(who)),
        run_directory(directory),
        token(random_token()),
        session(random_session()),
        context(make_context()),
        socket(context, zmq::socket_type::router),
        monitor(context, socket) {
    SocketSettings settings;
    settings.largest_message_bytes = static_cast<std::int64_t>(std::max(largest_message_bytes, smallest_limit));
    set_options(socket, settings);
    socket.set(zmq::sockopt::sndtimeo, send_timeout_ms);
    socket.set(zmq::sockopt::router_mandatory, true);
    socket.set(zmq::sockopt::router_handover, false);  // ids are the socket's own; a name is taken over by nobody
    address = "ipc://" + run_directory.socket_path();
    bind(address);
    if (!door.address.empty()) open(door);
  }

  void bind(const std::string& where) {
    try {
      socket.bind(where);
    } catch (const zmq::error_t& error) {
      throw Error(ExitCode::cannot_create, std::string("the socket cannot be bound: ") + error.what(), where);
    }
  }

  void open(const Door& door);

  Peer* by_name(const std::string& name) {
    for (auto& [id, peer] : peers)
      if (peer.name == name) return &peer;
    return nullptr;
  }

  Peer& connected(const std::string& name) {
    auto* peer = by_name(name);
    if (!peer) throw Error(ExitCode::unavailable, "'" + name + "' has not connected");
    return *peer;
  }

  void deliver(const Peer& peer, Span<const std::uint8_t> frame, const std::string& what) {
    if (!transmit(peer.routing_id, frame))
      throw Error(ExitCode::unavailable, "'" + peer.name + "' cannot be reached: " + what + " was not sent");
    if (observer) observer(peer.name, true, frame);
  }

  void note_connections(std::vector<EndpointEvent>& events);
  void report_lost(std::vector<EndpointEvent>& events);
  bool receive_one(std::vector<EndpointEvent>& events);
  void admit(const std::string& id, zmq::message_t& frame, const Message& message, std::vector<EndpointEvent>& events);
  void take(Peer& peer, Message message, std::vector<EndpointEvent>& events);
  void mark_broken(Peer& peer, ExitCode code, const std::string& problem, std::vector<EndpointEvent>& events);
  bool transmit(const std::string& id, Span<const std::uint8_t> frame);

  Admission admission;
  Observer observer;
  RunDirectory run_directory;
  std::string address, door_address, token;
  std::uint64_t session;
  zmq::context_t context;
  zmq::socket_t socket;
  SocketMonitor monitor;
  std::optional<Gatekeeper> gatekeeper;
  std::map<std::string, Peer> peers;  ///< by routing id
  std::set<int> closed;               ///< connections that ended and whose descriptor was not used again
};

/// Binds the door's address. Options hold for what is bound after them: the ipc socket stays without keys.
void CouplerEndpoint::Data::open(const Door& door) {
  if (!door.key.secret_key.empty()) {
    gatekeeper.emplace(context, door.allowed);
    socket.set(zmq::sockopt::zap_domain, "coupler");
    socket.set(zmq::sockopt::curve_server, true);
    socket.set(zmq::sockopt::curve_secretkey, door.key.secret_key);
  }
  bind(door.address);
  door_address = socket.get(zmq::sockopt::last_endpoint);
}

/// Follows the monitor: which descriptors are closed now, and who did not get through the handshake.
void CouplerEndpoint::Data::note_connections(std::vector<EndpointEvent>& events) {
  const auto turn_away = [&](const std::string& problem) {
    events.push_back({"", {}, problem, static_cast<int>(ExitCode::protocol)});
  };
  if (gatekeeper)
    for (const auto& problem : gatekeeper->answer()) turn_away(problem);
  while (const auto event = monitor.next()) {
    if (event->kind == ZMQ_EVENT_ACCEPTED) {
      // The descriptor is reused: the peer that had it must not be taken for this connection.
      for (auto& [id, peer] : peers)
        if (peer.fd == event->value) peer.fd = -1;
      closed.erase(event->value);
    } else if (event->kind == ZMQ_EVENT_DISCONNECTED) {
      closed.insert(event->value);
    } else if (event->kind & (ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL | ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL)) {
      turn_away("a connection was refused: " + failure_in_words(*event));
    }
  }
}

void CouplerEndpoint::Data::report_lost(std::vector<EndpointEvent>& events) {
  for (auto& [id, peer] : peers) {
    const bool lost = peer.fd < 0 || closed.count(peer.fd);
    if (lost && !peer.finished && !peer.broken)
      mark_broken(peer, ExitCode::unavailable, "the connection of '" + peer.name + "' is lost", events);
  }
}

void CouplerEndpoint::Data::mark_broken(Peer& peer, ExitCode code, const std::string& problem,
                                        std::vector<EndpointEvent>& events) {
  peer.broken = true;
  events.push_back({peer.name, {}, problem, static_cast<int>(code)});
}

bool CouplerEndpoint::Data::transmit(const std::string& id, Span<const std::uint8_t> frame) {
  try {
    // A router that took the first part takes the second: only the first can block or fail.
    return send_part(socket, zmq::buffer(id), zmq::send_flags::sndmore) &&
           send_part(socket, zmq::buffer(frame.data(), frame.size()), zmq::send_flags::none);
  } catch (const zmq::error_t& error) {
    if (error.num() == EHOSTUNREACH) return false;
    throw;
  }
}

/// Reads one frame, if there is one, and turns it into at most one event.
bool CouplerEndpoint::Data::receive_one(std::vector<EndpointEvent>& events) {
  zmq::message_t id_frame, frame, surplus;
  if (!receive_part(socket, id_frame)) return false;
  bool well_formed = id_frame.more() && receive_part(socket, frame);
  for (bool more = frame.more(); more; more = surplus.more()) {
    well_formed = false;
    if (!receive_part(socket, surplus)) break;
  }
  const std::string id = id_frame.to_string();
  const auto found = peers.find(id);
  if (found != peers.end() && found->second.broken) return true;
  const Span<const std::uint8_t> bytes(static_cast<const std::uint8_t*>(frame.data()), frame.size());
  if (observer && found != peers.end()) observer(found->second.name, false, bytes);
  try {
    if (!well_formed) throw Error(ExitCode::protocol, "a message is one frame");
    auto message = decode(bytes);
    note_connections(events);
    if (found == peers.end())
      admit(id, frame, message, events);
    else
      take(found->second, std::move(message), events);
  } catch (const Error& error) {
    if (found != peers.end())
      mark_broken(found->second, error.code(), "from '" + found->second.name + "': " + error.what(), events);
    else
      events.push_back({"", {}, std::string("from a stranger: ") + error.what(), static_cast<int>(error.code())});
  }
  return true;
}

void CouplerEndpoint::Data::admit(const std::string& id, zmq::message_t& frame, const Message& message,
                                  std::vector<EndpointEvent>& events) {
  std::vector<std::string> taken;
  for (const auto& [other, peer] : peers) taken.push_back(peer.name);
  const auto* hello = std::get_if<Hello>(&message.body);
  std::string reason = hello ? why_not_welcome(*hello, admission, token, taken)
                             : std::string("the first message must be Hello, not ") + name_of(message.body);
  const auto key = key_name(frame);
  if (reason.empty() && !key.empty() && key != hello->name) reason = "its key is that of '" + key + "'";
  if (!reason.empty()) {
    transmit(id, encode({0, 1, message.sequence, Reject{reason}}));
    const std::string who = hello ? "'" + hello->name + "'" : "a stranger";
    events.push_back({"", {}, who + " was rejected: " + reason, static_cast<int>(ExitCode::protocol)});
    return;
  }
  Peer peer;
  peer.name = hello->name;
  peer.routing_id = id;
  peer.fd = connection_of(frame);
  peer.received = message.sequence;
  peer.sent = 1;
  if (!transmit(id, encode({session, peer.sent, message.sequence, Welcome{session, admission.heartbeat_s}})))
    peer.fd = -1;
  peers[id] = peer;
  events.push_back({peer.name, message, "", 0});
}

void CouplerEndpoint::Data::take(Peer& peer, Message message, std::vector<EndpointEvent>& events) {
  const auto wrong = [&](const std::string& what, std::uint64_t found, std::uint64_t expected) {
    throw Error(ExitCode::protocol, std::string(name_of(message.body)) + " has the " + what + " " +
                                        std::to_string(found) + " instead of " + std::to_string(expected));
  };
  if (message.session != session) wrong("session", message.session, session);
  if (message.sequence != peer.received + 1) wrong("sequence number", message.sequence, peer.received + 1);
  peer.received = message.sequence;
  peer.last_frame = Clock::now();
  if (const auto* beat = std::get_if<Heartbeat>(&message.body)) {
    if (beat->progress != peer.beat.progress || beat->window != peer.beat.window) peer.last_change = peer.last_frame;
    peer.beat = *beat;
    return;
  }
  peer.last_change = peer.last_frame;
  peer.finished = peer.finished || std::holds_alternative<Bye>(message.body);
  events.push_back({peer.name, std::move(message), "", 0});
}

CouplerEndpoint::CouplerEndpoint(const std::string& directory, std::size_t largest_message_bytes, Admission admission,
                                 const Door& door)
    : data_(std::make_unique<Data>(directory, largest_message_bytes, std::move(admission), door)) {}

CouplerEndpoint::~CouplerEndpoint() = default;

const std::string& CouplerEndpoint::address() const {
  return data_->address;
}
const std::string& CouplerEndpoint::door_address() const {
  return data_->door_address;
}
const std::string& CouplerEndpoint::session_token() const {
  return data_->token;
}
std::uint64_t CouplerEndpoint::session() const {
  return data_->session;
}

std::vector<EndpointEvent> CouplerEndpoint::wait(double timeout_s, int extra_fd) {
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s));
  std::vector<EndpointEvent> events;
  while (true) {
    data_->note_connections(events);
    for (int n = 0; n < most_frames_at_once && data_->receive_one(events); ++n) {
    }
    data_->report_lost(events);
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (!events.empty() || left.count() <= 0) return events;
    std::vector<zmq::pollitem_t> items{{data_->socket.handle(), 0, ZMQ_POLLIN, 0},
                                       {data_->monitor.handle(), 0, ZMQ_POLLIN, 0}};
    if (data_->gatekeeper) items.push_back({data_->gatekeeper->handle(), 0, ZMQ_POLLIN, 0});
    if (extra_fd >= 0) items.push_back({nullptr, extra_fd, ZMQ_POLLIN | ZMQ_POLLERR, 0});
    poll_sockets(items, left);
    if (extra_fd >= 0 && items.back().revents) return events;
  }
}

std::uint64_t CouplerEndpoint::send(const std::string& participant, Body body) {
  auto& peer = data_->connected(participant);
  const std::string what = name_of(body);
  data_->deliver(peer, encode({data_->session, peer.sent + 1, 0, std::move(body)}), what);
  peer.last_change = Clock::now();
  return ++peer.sent;
}

void CouplerEndpoint::send_bytes(const std::string& participant, Span<const std::uint8_t> frame) {
  data_->deliver(data_->connected(participant), frame, "a frame");
}

void CouplerEndpoint::observe(Observer observer) {
  data_->observer = std::move(observer);
}

CouplerEndpoint::Pulse CouplerEndpoint::pulse(const std::string& participant) const {
  const auto* peer = data_->by_name(participant);
  if (!peer) return {};
  return {seconds_since(peer->last_frame), peer->beat.window, peer->beat.progress, seconds_since(peer->last_change)};
}

}  // namespace proto
