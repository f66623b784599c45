// What a solver links to take part in a coupled run: implement Participant, call serve().
//
// Call order (the coupler leads; the session checks it and answers a break of it with a fault):
//
//     watch, name, capabilities, build_id -> describe -> configure -> [advance(initialise) residual commit]*
//         -> start largest_step -> [advance largest_step [rollback advance largest_step]* commit]* -> finish
//     save / restore between a commit and the next advance; a restore instead of initialise and start resumes a run
//
// serve() owns a communication thread, which holds the socket and sends heartbeats while the solver computes. All
// functions of the Participant are called on the thread that called serve(). No ZeroMQ or FlatBuffers type is visible.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>

#include "proto/error.hpp"
#include "proto/session/curve_keys.hpp"
#include "proto/wire/messages.hpp"

namespace proto {

/// Work counter that a solver bumps while it computes (each sub-step, each solver iteration). The coupler takes a
/// participant whose heartbeats repeat the same count for hung.
class Progress {
 public:
  void bump() noexcept { count_.fetch_add(1, std::memory_order_relaxed); }
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> count_{0};
};

/// A solver as the coupler sees it. Anything thrown ends the session: the text goes to the coupler as a fault (a
/// proto::Error keeps its exit code) and serve() rethrows. The object is not called again after a throw.
class Participant {
 public:
  virtual ~Participant() = default;

  /// First call: the counter that the heartbeats carry. A solver that works for long outside advance() (reading a bed
  /// in configure(), writing in commit()) keeps the reference, which lives until serve() ends, and bumps it there too.
  virtual void watch(Progress& progress);

  /// Version of the solver for the record, e.g. "qdem_solver 0.1.0".
  virtual std::string build_id() const;

  /// Name, capabilities.
  virtual std::string name() const = 0;
  virtual Capabilities capabilities() const = 0;

  /// Reads nothing from the wire: the cells of the case's rail seats as this solver sees them, and the fields it takes
  /// and gives.
  virtual Interface describe() = 0;

  /// Window length, number of windows, pad law; vectors of pad values are empty or as long as a field. Returns the
  /// largest stable step [s] if the solver is explicit.
  virtual Configured configure(const Configure& request) = 0;

  /// Solves one window. `request.phase` = initialise: with artificial damping, clocks standing. A second call for the
  /// same window comes only after rollback().
  virtual FieldSet advance(const Advance& request, Progress& progress) = 0;

  /// How far the state just advanced to is from static equilibrium: size of the out-of-balance force over the size of
  /// the forces that should balance, at least 0 [-]. Asked for in the initialise phase only; the coupler ends the run
  /// of a solver that offers initialise and gives none.
  virtual std::optional<double> residual();

  /// Largest stable step [s] of the window that follows the state just started from or advanced to, if it changes along
  /// the way; without, configure()'s holds for the whole march. Same state, same step: a window that is solved again
  /// after a rollback gets the sub-cycles that it got before.
  virtual std::optional<double> largest_step();

  /// The window just advanced is final; write output here.
  virtual void commit(const Commit& request) = 0;

  /// Back to the state of the last commit. Only if capabilities().rollback.
  virtual void rollback(const Rollback& request);

  /// Ends the initialise phase: damping off, clock to 0. Returns the initial values of the outgoing fields.
  virtual FieldSet start() = 0;

  /// Writes / reads the whole mutable state; save returns its hash. Only if capabilities().save_restore.
  virtual std::uint64_t save(const Save& request);
  virtual void restore(const Restore& request);

  /// Closes output; facts for the summary.
  virtual std::vector<Fact> finish() = 0;
};

/// Where the coupler is.
struct SessionOptions {
  std::string endpoint;       ///< e.g. ipc:///run/user/0/qdem-fem-1234/coupler, tcp://10.0.0.1:41234
  std::string session_token;  ///< secret of this run, from the environment variable QDEM_FEM_SESSION_TOKEN
  std::uint64_t case_hash = 0;
  double connect_timeout_s = 30.0;
  double peer_timeout_s = 15.0;  ///< without any sign of the coupler's process
  std::string server_key;        ///< the coupler's public key (Z85); empty: neither encrypted nor authenticated
  KeyPair key;                   ///< with server_key: this participant's
};

/// Files of an encrypted connection, from `--server-key` and `--key`; both or none.
struct KeyFiles {
  std::string server, own;
};

/// Options from the `--endpoint` argument, the environment variable QDEM_FEM_SESSION_TOKEN and the files of keys.
/// Throws proto::Error: usage when endpoint or token is missing, when one of the two files is given alone, or none
/// and the endpoint lies on another machine; what read_key_pair() throws.
SessionOptions read_session_options(const std::string& endpoint, std::uint64_t case_hash, const KeyFiles& keys = {});

/// Runs the session to its end. Returns after Finish/Bye.
///
/// Checks what the participant gives as well: a field of wrong length, one that describe() did not list as outgoing
/// (internal), or a number that is not finite (numerics; the text names field, seat, cell, axis and window).
/// When the coupler is lost while the participant computes, and its call does not return within 1 s, the process ends
/// with exit code 69 after a line on stderr: nobody would take the result.
/// Throws proto::Error: unavailable (no coupler, coupler lost or stopped by a fault), protocol (a message out of order
/// or malformed, a rejected handshake, with the coupler's reason), or whatever the participant threw.
void serve(Participant& participant, const SessionOptions& options);

}  // namespace proto
