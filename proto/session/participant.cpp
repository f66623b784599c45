#include "proto/session/participant.hpp"

#include <cstdlib>

#include "proto/session/connection.hpp"
#include "proto/session/session.hpp"

namespace proto {
namespace {

[[noreturn]] void not_offered(const char* what) {
  throw Error(ExitCode::protocol, std::string(what) + " was asked of a participant that cannot do it");
}

void converse(Session& session, Connection& connection, const SessionOptions& options) {
  connection.send(session.hello(options));
  while (!session.finished()) {
    const Message request = connection.receive();
    if (const auto* advance = std::get_if<Advance>(&request.body)) connection.set_window(advance->window);
    auto answer = session.handle(request.body);
    // The registration follows the handshake by itself; everything else answers a request.
    const bool asked = !std::holds_alternative<Welcome>(request.body);
    if (answer) connection.send(std::move(*answer), asked ? request.sequence : 0);
  }
}

}  // namespace

void Participant::watch(Progress&) {}
std::string Participant::build_id() const {
  return {};
}
std::optional<double> Participant::residual() {
  return {};
}
std::optional<double> Participant::largest_step() {
  return {};
}
void Participant::rollback(const Rollback&) {
  not_offered("Rollback");
}
std::uint64_t Participant::save(const Save&) {
  not_offered("Save");
}
void Participant::restore(const Restore&) {
  not_offered("Restore");
}

SessionOptions read_session_options(const std::string& endpoint, std::uint64_t case_hash, const KeyFiles& keys) {
  const char* token = std::getenv("QDEM_FEM_SESSION_TOKEN");
  if (endpoint.empty())
    throw Error(ExitCode::usage, "no endpoint", "--endpoint", "a participant is started by the coupler");
  if (!token || !*token)
    throw Error(ExitCode::usage, "no session token", "environment variable QDEM_FEM_SESSION_TOKEN",
                "a participant is started by the coupler");
  SessionOptions options;
  options.endpoint = endpoint;
  options.session_token = token;
  options.case_hash = case_hash;
  if (keys.server.empty() != keys.own.empty())
    throw Error(ExitCode::usage, "one key is missing", keys.own.empty() ? "--key" : "--server-key",
                "an encrypted connection needs the participant's secret key and the coupler's public one");
  if (keys.own.empty() && needs_keys(endpoint))
    throw Error(ExitCode::usage, "a connection to another machine needs keys", endpoint, "give --key and --server-key");
  if (!keys.own.empty()) {
    options.server_key = read_public_key(keys.server);
    options.key = read_key_pair(keys.own);
  }
  return options;
}

void serve(Participant& participant, const SessionOptions& options) {
  Progress progress;
  Session session(participant, progress);
  Connection connection(options, progress);
  // The coupler learns of whatever ends the session here; the program's main function decides what to print.
  try {
    converse(session, connection, options);
  } catch (const Error& error) {
    if (!connection.failed()) connection.send(Fault{static_cast<int>(error.code()), error.what()});
    throw;
  } catch (const std::exception& error) {
    connection.send(Fault{static_cast<int>(ExitCode::internal), error.what()});
    throw;
  }
}

}  // namespace proto
