// Peers that speak the wire without the session's manners, for what a well-behaved one cannot send.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>
#include <zmq.hpp>

#include "proto/session/coupler_endpoint.hpp"
#include "proto/wire/codec.hpp"

namespace tests {

using Bytes = std::vector<std::uint8_t>;

/// A participant made by hand.
class RawDealer {
 public:
  explicit RawDealer(const std::string& address) : socket_(context_, zmq::socket_type::dealer) {
    socket_.set(zmq::sockopt::linger, 0);
    socket_.set(zmq::sockopt::rcvtimeo, 5000);
    socket_.connect(address);
  }
  void send(const proto::Message& message) { send(proto::encode(message)); }
  void send(const Bytes& bytes) { socket_.send(zmq::buffer(bytes), zmq::send_flags::none); }
  void send_two_parts(const Bytes& bytes) {
    socket_.send(zmq::buffer(bytes), zmq::send_flags::sndmore);
    send(bytes);
  }
  proto::Message receive() {
    zmq::message_t frame;
    if (!socket_.recv(frame)) throw std::runtime_error("nothing came in 5 s");
    return proto::decode({frame.data<std::uint8_t>(), frame.size()});
  }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_;
};

/// A coupler made by hand, for one participant.
class RawRouter {
 public:
  explicit RawRouter(const std::string& address) : socket_(context_, zmq::socket_type::router) {
    socket_.set(zmq::sockopt::linger, 0);
    socket_.set(zmq::sockopt::rcvtimeo, 5000);
    socket_.bind(address);
  }
  void send(const proto::Message& message) { send(proto::encode(message)); }
  void send(const Bytes& bytes) {
    socket_.send(zmq::buffer(peer_), zmq::send_flags::sndmore);
    socket_.send(zmq::buffer(bytes), zmq::send_flags::none);
  }
  /// The next message that is no heartbeat.
  proto::Message receive() {
    while (true) {
      zmq::message_t id, frame;
      if (!socket_.recv(id) || !socket_.recv(frame)) throw std::runtime_error("nothing came in 5 s");
      peer_ = id.to_string();
      auto message = proto::decode({frame.data<std::uint8_t>(), frame.size()});
      if (!std::holds_alternative<proto::Heartbeat>(message.body)) return message;
    }
  }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_;
  std::string peer_;
};

}  // namespace tests
