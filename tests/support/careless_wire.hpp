// A participant's end of the wire that can be told to break the protocol's manners, one at a time: what proto::serve()
// does not let a participant do. Computes on a thread of its own, so that it can send heartbeats meanwhile.
#pragma once

#include <unistd.h>

#include <chrono>
#include <deque>
#include <future>
#include <optional>
#include <string>
#include <thread>

#include "proto/session/participant.hpp"
#include "proto/session/session.hpp"
#include "proto/session/sockets.hpp"
#include "proto/wire/codec.hpp"

namespace tests {

/// `fault`: none, wrong_name, stays_when_rejected, forgets_answers, any_order, takes_nan, any_length,
/// crashes_on_damage, any_session, any_size, no_heartbeats, no_progress, deaf_to_faults, stays_alone.
class CarelessWire {
 public:
  CarelessWire(proto::Participant& participant, const proto::SessionOptions& options, std::string fault)
      : fault_(std::move(fault)),
        context_(proto::make_context()),
        socket_(context_, zmq::socket_type::dealer),
        monitor_(context_, socket_),
        session_(participant, progress_) {
    proto::SocketSettings settings;
    if (fault_ == "any_size") settings.largest_message_bytes = -1;
    proto::set_options(socket_, settings);
    socket_.set(zmq::sockopt::immediate, false);
    socket_.connect(options.endpoint);
    auto hello = session_.hello(options);
    if (fault_ == "wrong_name") hello.name += "_too";
    send(hello, 0);
  }

  /// Returns after Bye; leaves the process in any other case.
  void run() {
    while (!session_.finished() || pending_.valid()) {
      take_answer();
      receive();
      if (!pending_.valid() && !inbox_.empty()) begin();
      beat();
      watch_connection();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  void send(proto::Body body, std::uint64_t in_reply_to) {
    const auto frame = proto::encode({session_number_, ++sent_, in_reply_to, std::move(body)});
    proto::send_part(socket_, zmq::buffer(frame), zmq::send_flags::none);
  }

  /// At once, whatever is being computed; a moment later, so that the last message goes first.
  [[noreturn]] void leave(int code) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    _exit(code);
  }

  void refuse(const proto::Error& error) {
    const std::string text = error.what();
    const bool of_length = text.find("the registered cells have") != std::string::npos;
    const bool of_order = text.find("out of order") != std::string::npos;
    if ((fault_ == "any_length" && of_length) || (fault_ == "any_order" && of_order)) return;
    if (fault_ == "takes_nan" && error.code() == proto::ExitCode::numerics) return;
    if (fault_ == "any_size" && text.find("size") != std::string::npos) return;
    if (fault_ == "crashes_on_damage" && error.code() == proto::ExitCode::protocol) std::abort();
    send(proto::Fault{static_cast<int>(error.code()), text}, 0);
    leave(static_cast<int>(error.code()));
  }

  void take_answer() {
    if (!pending_.valid() || pending_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    try {
      if (auto answer = pending_.get()) {
        const bool asked = !std::holds_alternative<proto::Interface>(*answer);
        send(*answer, asked ? request_.sequence : 0);
        answer_ = answer;
      }
    } catch (const proto::Error& error) {
      refuse(error);
    }
  }

  void begin() {
    request_ = inbox_.front();
    inbox_.pop_front();
    pending_ = std::async(std::launch::async, [this] { return session_.handle(request_.body); });
  }

  void receive() {
    zmq::message_t frame;
    while (proto::receive_part(socket_, frame)) try {
        take(proto::decode({frame.data<std::uint8_t>(), frame.size()}));
      } catch (const proto::Error& error) {
        refuse(error);
      }
  }

  void take(const proto::Message& message) {
    if (message.sequence == received_ && fault_ != "forgets_answers") return send(*answer_, message.sequence);
    const bool known = !session_number_ || message.session == session_number_;
    if ((!known || message.sequence != received_ + 1) && fault_ != "any_session")
      throw proto::Error(proto::ExitCode::protocol, "another session or a gap");
    received_ = message.sequence;
    if (std::holds_alternative<proto::Fault>(message.body)) {
      if (fault_ != "deaf_to_faults") leave(69);
      return;
    }
    if (std::holds_alternative<proto::Reject>(message.body)) {
      if (fault_ != "stays_when_rejected") leave(76);
      return;
    }
    if (const auto* welcome = std::get_if<proto::Welcome>(&message.body)) {
      session_number_ = welcome->session;
      heartbeat_s_ = welcome->heartbeat_s;
    }
    inbox_.push_back(message);
  }

  void beat() {
    if (!session_number_ || Clock::now() < next_beat_ || session_.finished()) return;
    if (fault_ == "no_heartbeats" && pending_.valid()) return;
    next_beat_ =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(heartbeat_s_));
    send(proto::Heartbeat{0, fault_ == "no_progress" ? 0 : progress_.count()}, 0);
  }

  void watch_connection() {
    while (const auto event = monitor_.next())
      if (event->kind == ZMQ_EVENT_DISCONNECTED && fault_ != "stays_alone") leave(69);
  }

  using Clock = std::chrono::steady_clock;

  std::string fault_;
  zmq::context_t context_;
  zmq::socket_t socket_;
  proto::SocketMonitor monitor_;
  proto::Progress progress_;
  proto::Session session_;
  std::uint64_t session_number_ = 0, sent_ = 0, received_ = 0;
  double heartbeat_s_ = 1.0;
  Clock::time_point next_beat_ = Clock::now();
  std::deque<proto::Message> inbox_;
  proto::Message request_;
  std::future<std::optional<proto::Body>> pending_;
  std::optional<proto::Body> answer_;
};

}  // namespace tests
