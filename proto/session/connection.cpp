#include "proto/session/connection.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "proto/wire/codec.hpp"

namespace proto {
namespace {

constexpr std::chrono::seconds flush_time{1};
constexpr std::chrono::seconds grace{1};
constexpr std::size_t longest_queue = 32;  // lock-step never has more than a few messages under way

std::chrono::steady_clock::duration seconds(double s) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(s));
}

SocketSettings settings_of(const SessionOptions& options) {
  SocketSettings settings;
  settings.peer_timeout_ms = static_cast<int>(options.peer_timeout_s * 1e3);
  return settings;
}

}  // namespace

Connection::Connection(const SessionOptions& options, const Progress& progress)
    : options_(options),
      progress_(progress),
      over_ipc_(options.endpoint.rfind("ipc://", 0) == 0),
      context_(make_context()),
      socket_(context_, zmq::socket_type::dealer),
      monitor_(context_, socket_),
      connect_deadline_(Clock::now() + seconds(options.connect_timeout_s)),
      next_beat_(Clock::now()),
      wake_fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (wake_fd_ < 0) throw Error(ExitCode::os_error, "no event descriptor is left");
  set_options(socket_, settings_of(options_));
  // With "immediate" libzmq drops what was received and not yet read when the connection ends: the coupler's last
  // words. What is queued before the connection is the Hello only.
  socket_.set(zmq::sockopt::immediate, false);
  // Before the coupler is there we try again; once connected, a loss ends the session before a reconnection can.
  socket_.set(zmq::sockopt::reconnect_ivl, 200);
  if (!options_.server_key.empty()) {
    socket_.set(zmq::sockopt::curve_serverkey, options_.server_key);
    socket_.set(zmq::sockopt::curve_publickey, options_.key.public_key);
    socket_.set(zmq::sockopt::curve_secretkey, options_.key.secret_key);
  }
  try {
    socket_.connect(options_.endpoint);
  } catch (const zmq::error_t& error) {
    close(wake_fd_);
    throw Error(ExitCode::usage, std::string("the endpoint cannot be used: ") + error.what(), options_.endpoint,
                "give the --endpoint that the coupler prints");
  }
  thread_ = std::thread([this] { run(); });
}

Connection::~Connection() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  wake();
  thread_.join();
  close(wake_fd_);
}

void Connection::send(Body body, std::uint64_t in_reply_to) {
  {
    const std::lock_guard lock(mutex_);
    outbound_.push_back({std::move(body), in_reply_to});
  }
  wake();
}

Message Connection::receive() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return !inbound_.empty() || failure_; });
  if (failure_) throw Error(*failure_);
  Message message = std::move(inbound_.front());
  inbound_.pop_front();
  return message;
}

bool Connection::failed() {
  const std::lock_guard lock(mutex_);
  return failure_.has_value();
}

void Connection::set_window(std::int64_t window) {
  const std::lock_guard lock(mutex_);
  window_ = window;
}

void Connection::wake() {
  const std::uint64_t one = 1;
  // A full counter means that the thread is going to wake up anyway.
  [[maybe_unused]] const auto written = write(wake_fd_, &one, sizeof one);
}

void Connection::run() {
  try {
    while (turn()) {
    }
  } catch (const zmq::error_t& error) {
    fail(Error(ExitCode::unavailable, std::string("the connection to the coupler broke: ") + error.what(),
               options_.endpoint));
  }
  leave_after_failure();
}

/// One turn of the communication thread: false at the end of the session.
bool Connection::turn() {
  std::vector<zmq::pollitem_t> items{
      {socket_.handle(), 0, static_cast<short>(ZMQ_POLLIN | (blocked_ ? ZMQ_POLLOUT : 0)), 0},
      {monitor_.handle(), 0, ZMQ_POLLIN, 0},
      {nullptr, wake_fd_, ZMQ_POLLIN, 0}};
  poll_sockets(items, nap());
  std::uint64_t ignored;
  [[maybe_unused]] const auto taken = read(wake_fd_, &ignored, sizeof ignored);
  // The order matters: the coupler's last messages lie before the event of its going.
  watch_connection();
  try {
    take_frames();
    if (!refusal_.empty())
      throw Error(ExitCode::protocol, "the connection was refused: " + refusal_, options_.endpoint,
                  "see --key and --server-key");
    if (lost_ && !finished_) throw Error(ExitCode::unavailable, "the coupler is gone", options_.endpoint);
    if (!session_ && Clock::now() > connect_deadline_)
      throw Error(ExitCode::unavailable, "no coupler answered in time", options_.endpoint, "is it running?");
  } catch (const Error& error) {
    if (session_ && error.code() != ExitCode::unavailable)
      deliver({Fault{static_cast<int>(error.code()), error.what()}});
    fail(error);
  }
  deliver_queue();
  beat();
  const std::lock_guard lock(mutex_);
  return !failure_ && !closing_;
}

std::chrono::milliseconds Connection::nap() const {
  const auto due = session_ ? next_beat_ : connect_deadline_;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(due - Clock::now());
  return std::clamp(left, std::chrono::milliseconds(0), std::chrono::milliseconds(1000));
}

void Connection::watch_connection() {
  while (const auto event = monitor_.next()) {
    lost_ = lost_ || event->kind == ZMQ_EVENT_DISCONNECTED;
    if (event->kind == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH)
      refusal_ = "the coupler does not know this key";
    else if (event->kind == ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL)
      refusal_ = options_.key.public_key.empty() ? "the coupler asks for a key" : "the coupler takes no keys";
    else if (event->kind == ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL && !over_ipc_)
      refusal_ = options_.key.public_key.empty() ? "it ended in its handshake, as it does where a key is asked for"
                                                 : "it ended in its handshake, as it does with another coupler's key";
  }
}

void Connection::take_frames() {
  zmq::message_t frame;
  while (receive_part(socket_, frame)) {
    if (frame.more()) throw Error(ExitCode::protocol, "malformed frame: a message is one frame");
    take(decode({static_cast<const std::uint8_t*>(frame.data()), frame.size()}));
  }
}

bool Connection::is_repeated(const Message& message) const {
  const auto* advance = std::get_if<Advance>(&message.body);
  return advance && last_advance_ && message.sequence == last_advance_->sequence &&
         advance->phase == last_advance_->phase && advance->window == last_advance_->window &&
         advance->iteration == last_advance_->iteration;
}

void Connection::check_order(const Message& message) const {
  const std::string name = name_of(message.body);
  if (session_ && message.session != session_)
    throw Error(ExitCode::protocol, name + " belongs to another session: " + std::to_string(message.session));
  if (message.sequence != received_ + 1)
    throw Error(ExitCode::protocol, name + " has the sequence number " + std::to_string(message.sequence) +
                                        " instead of " + std::to_string(received_ + 1));
}

void Connection::take(Message message) {
  if (is_repeated(message) && message.session == session_) {
    // Still computing: the answer comes by itself. Answered: the same answer once more.
    if (last_result_ && last_result_->in_reply_to == message.sequence) deliver(*last_result_);
    return;
  }
  check_order(message);
  received_ = message.sequence;
  if (const auto* fault = std::get_if<Fault>(&message.body))
    throw Error(ExitCode::unavailable, "the coupler stopped the run: " + fault->text);
  if (const auto* reject = std::get_if<Reject>(&message.body))
    throw Error(ExitCode::protocol, "the coupler rejected this participant: " + reject->reason, options_.endpoint);
  if (std::holds_alternative<Heartbeat>(message.body)) return;
  if (const auto* welcome = std::get_if<Welcome>(&message.body)) {
    session_ = welcome->session;
    heartbeat_s_ = std::max(welcome->heartbeat_s, 0.01);
  }
  if (const auto* advance = std::get_if<Advance>(&message.body))
    last_advance_ = Request{message.sequence, advance->phase, advance->window, advance->iteration};
  const std::lock_guard lock(mutex_);
  inbound_.push_back(std::move(message));
  if (inbound_.size() > longest_queue)
    throw Error(ExitCode::protocol, "the coupler sends messages without waiting for answers");
  changed_.notify_all();
}

/// False when the socket takes nothing at the moment.
bool Connection::deliver(const Outgoing& outgoing) {
  const auto frame = encode({session_, sent_ + 1, outgoing.in_reply_to, outgoing.body});
  if (!send_part(socket_, zmq::buffer(frame), zmq::send_flags::dontwait)) return false;
  ++sent_;
  if (std::holds_alternative<Bye>(outgoing.body)) finished_ = true;
  return true;
}

void Connection::deliver_queue() {
  std::unique_lock lock(mutex_);
  blocked_ = false;
  while (!outbound_.empty() && !blocked_) {
    Outgoing next = std::move(outbound_.front());
    lock.unlock();
    blocked_ = !deliver(next);
    lock.lock();
    if (blocked_) {
      outbound_.front() = std::move(next);
      return;
    }
    outbound_.pop_front();
    if (std::holds_alternative<Result>(next.body)) last_result_ = std::move(next);
  }
}

void Connection::beat() {
  if (!session_ || finished_ || Clock::now() < next_beat_) return;
  next_beat_ = Clock::now() + seconds(heartbeat_s_);
  std::int64_t window;
  {
    const std::lock_guard lock(mutex_);
    window = window_;
  }
  // One that does not fit in is left out: the coupler has older ones to read.
  deliver({Heartbeat{window, progress_.count()}});
}

void Connection::fail(const Error& error) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = error;
  changed_.notify_all();
}

/// Sends what is left; with a failure, sees to it that a computation nobody waits for does not go on.
void Connection::leave_after_failure() {
  std::unique_lock lock(mutex_);
  if (failure_ && !changed_.wait_for(lock, grace, [&] { return closing_; })) {
    std::fprintf(stderr, "%s - the computation was abandoned\n", failure_->what());
    std::fflush(stderr);
    _exit(static_cast<int>(ExitCode::unavailable));
  }
  lock.unlock();
  if (!session_) socket_.set(zmq::sockopt::linger, 0);  // nobody there to say anything to
  const auto deadline = Clock::now() + flush_time;
  do {
    deliver_queue();
    if (blocked_) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  } while (blocked_ && session_ && !lost_ && Clock::now() < deadline);
}

}  // namespace proto
