// Whose CURVE keys are let in: the ZAP handler (ZeroMQ RFC 27) of the coupler's context; private to this folder.
#pragma once

#include <map>
#include <string>
#include <vector>
#include <zmq.hpp>

namespace proto {

/// Answers libzmq's question for every client of a CURVE socket of this context. Whom it lets in gets the name of its
/// key as the property "User-Id" of each of its messages.
class Gatekeeper {
 public:
  /// `allowed`: public keys (Z85) by name.
  Gatekeeper(zmq::context_t& context, const std::map<std::string, std::string>& allowed);

  /// Answers the questions that are there, without waiting. One text for each client that was refused.
  std::vector<std::string> answer();
  /// To poll for questions.
  void* handle() { return static_cast<void*>(socket_); }

 private:
  zmq::socket_t socket_;
  std::map<std::string, std::string> names_;  ///< by key, as 32 bytes
};

}  // namespace proto
