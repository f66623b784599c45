// One started participant, driven through the protocol by a check.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupler/conformance/bench.hpp"
#include "coupler/conformance/motion.hpp"
#include "coupler/launch/children.hpp"
#include "coupler/mapping/mapped_side.hpp"
#include "coupler/record/socket_folder.hpp"
#include "coupler/supervise/supervisor.hpp"
#include "proto/session/coupler_endpoint.hpp"

namespace coupler::conformance {

/// How far a participant has come: the states of proto/README.md "Legal order".
enum class Stage { connected, registered, configured, marching, advanced };

/// How a participant ended, or did not.
struct Ending {
  std::optional<proto::Fault> fault;  ///< that it sent
  std::optional<ChildExit> exit;      ///< empty: it still runs
  double seconds = 0.0;               ///< until then
  std::string text() const;
};

/// What a check may want otherwise.
struct Settings {
  std::optional<proto::LoadMode> mode;  ///< of fem; empty: robin if it is offered
  double window_share = 1.0;            ///< of the case's window
  std::uint32_t sub_cycle_factor = 1;   ///< more sub-cycles than the step asks for
  std::uint64_t other_case = 0;         ///< not 0: its case counts as another one, it is to be rejected
  std::string folder;                   ///< for its output; empty: a new one
};

/// A participant's own account of where it is, for another process to go on from.
struct Saving {
  std::int64_t window = 0;
  std::string path, folder;
  std::uint64_t hash = 0;
  proto::Result initial;
  std::optional<double> step_s;
};

/// The process lives as long as the object. Functions throw ParticipantError when the participant fails, Interrupted
/// when the user stops the suite.
class Subject {
 public:
  /// Starts the participant. `bench` must outlive the object.
  explicit Subject(Bench& bench, const Settings& settings = {});
  /// Ends the process, and whatever it started.
  ~Subject();
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

  /// Goes on to `stage`, by windows as the suite's motion has them.
  void bring_to(Stage stage);

  const proto::Hello& hello() const { return hello_; }
  const proto::Interface& interface() const { return interface_; }
  const proto::Configured& configured() const { return configured_; }
  const proto::Result& initial() const { return initial_; }  ///< answer to Start
  const Motion& motion() const { return *motion_; }
  /// A motion that the participant gave, at the pad's cells.
  std::vector<double> at_cells(const std::vector<double>& motion) const;
  /// A request made for the cells, as the participant gets it.
  proto::Advance on_wire(proto::Advance request) const;
  /// Length of a field on the wire.
  std::size_t n_values_of(const std::string& name) const;
  double window_s() const { return window_s_; }

  /// The request of the window and iteration that are due.
  proto::Advance request(double scale = 1.0) const;
  proto::Result solve(const proto::Advance& request);
  /// As solve(); `look` is called every few milliseconds of waiting.
  proto::Result solve(const proto::Advance& request, const std::function<void()>& look);
  void commit();
  void rollback();
  /// Solves and commits `n` windows.
  std::vector<proto::Result> march(int n);
  Saving save();
  void restore(const Saving& saving);
  /// Finish and Bye, then the process's exit.
  std::vector<proto::Fact> finish();

  /// Sends and waits for nothing; the number of the message.
  std::uint64_t send(proto::Body body) { return sent_ = supervisor_->send(name_, std::move(body)); }
  template <class T>
  T ask(proto::Body body) {
    return supervisor_->await<T>(name_, send(std::move(body)), true);
  }
  template <class T>
  T await(std::uint64_t in_reply_to, bool set_up = false) {
    return supervisor_->await<T>(name_, in_reply_to, set_up);
  }
  /// What send() would send next.
  proto::Message next_message(proto::Body body) const { return {endpoint_->session(), sent_ + 1, 0, std::move(body)}; }
  void send_bytes(const std::vector<std::uint8_t>& frame) { endpoint_->send_bytes(name_, frame); }
  proto::CouplerEndpoint::Pulse pulse() const { return endpoint_->pulse(name_); }

  /// Waits at most `limit_s` for the process to end; reads what it still says.
  Ending ending(double limit_s);
  /// The coupler's end of the wire is gone from here on.
  void lose_coupler() { supervisor_.reset(), endpoint_.reset(); }
  void kill_process() const;
  /// Processes that the participant started and that still run, itself among them.
  std::vector<int> processes() const;

  static constexpr double heartbeat_s = 0.1;

 private:
  void take_step();
  void configure();
  void begin(const proto::Result& initial);

  const Candidate& candidate_;
  Settings settings_;
  std::string name_, folder_, token_;
  double window_s_;
  proto::LoadMode mode_ = proto::LoadMode::robin;
  SocketFolder sockets_;
  Children children_;
  std::unique_ptr<proto::CouplerEndpoint> endpoint_;
  std::unique_ptr<Supervisor> supervisor_;

  std::optional<Stage> stage_;
  proto::Hello hello_;
  proto::Interface interface_;
  proto::Configured configured_;
  proto::Result initial_, last_;
  std::optional<PadMap> map_;
  std::optional<Motion> motion_;
  std::optional<double> step_s_;
  std::int64_t window_ = 0;
  std::uint32_t iteration_ = 0;
  std::uint64_t sent_ = 1;  // Welcome
};

/// The first value in which two answers differ in a bit, in words; "" when they are the same.
std::string difference(const proto::Result& found, const proto::Result& wanted);

}  // namespace coupler::conformance
