#include "proto/session/gatekeeper.hpp"

#include <array>

#include "proto/session/sockets.hpp"

namespace proto {
namespace {

/// The parts of a question of ZAP 1.0, in their order.
enum Part { version, request_id, domain, address, routing_id, mechanism, credentials, n_parts };

std::string binary(const std::string& z85) {
  std::string key(32, '\0');
  zmq_z85_decode(reinterpret_cast<std::uint8_t*>(key.data()), z85.c_str());
  return key;
}

std::string printable(const std::string& key) {
  if (key.size() != 32) return "none";
  std::array<char, 41> z85{};
  return zmq_z85_encode(z85.data(), reinterpret_cast<const std::uint8_t*>(key.data()), key.size());
}

}  // namespace

Gatekeeper::Gatekeeper(zmq::context_t& context, const std::map<std::string, std::string>& allowed)
    : socket_(context, zmq::socket_type::rep) {
  for (const auto& [name, key] : allowed) names_[binary(key)] = name;
  socket_.set(zmq::sockopt::linger, 0);
  socket_.bind("inproc://zeromq.zap.01");
}

std::vector<std::string> Gatekeeper::answer() {
  std::vector<std::string> refused;
  for (zmq::message_t part; receive_part(socket_, part);) {
    std::vector<std::string> question{part.to_string()};
    while (part.more() && receive_part(socket_, part)) question.push_back(part.to_string());
    question.resize(n_parts);
    const auto found = question[mechanism] == "CURVE" ? names_.find(question[credentials]) : names_.end();
    const bool known = found != names_.end();
    if (!known)
      refused.push_back("a connection from " + question[address] + " was refused: its key " +
                        printable(question[credentials]) + " is not on the list");
    const std::string reply[] = {
        "1.0", question[request_id], known ? "200" : "400", known ? "OK" : "unknown key", known ? found->second : "",
        ""};
    for (const auto& text : reply)
      send_part(socket_, zmq::buffer(text), &text == &reply[5] ? zmq::send_flags::none : zmq::send_flags::sndmore);
  }
  return refused;
}

}  // namespace proto
