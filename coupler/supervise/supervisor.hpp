// Talks to the participants of a run and notices at once when one of them fails.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "coupler/launch/children.hpp"
#include "proto/error.hpp"
#include "proto/session/coupler_endpoint.hpp"

namespace coupler {

/// A participant failed; carries its name for the summary.
class ParticipantError : public proto::Error {
 public:
  ParticipantError(std::string participant, proto::ExitCode code, const std::string& problem,
                   const std::string& where = {}, const std::string& advice = {})
      : proto::Error(code, problem, where, advice), participant_(std::move(participant)) {}
  const std::string& participant() const { return participant_; }

 private:
  std::string participant_;
};

/// The user asked the run to stop, and there is nothing to wait for.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(int signal) : std::runtime_error("interrupted"), signal_(signal) {}
  int signal() const { return signal_; }

 private:
  int signal_;
};

/// How long the coupler waits. Every wait ends by one of these.
struct Patience {
  double connect_s = 60.0;   ///< from the start to every Hello
  double set_up_s = 3600.0;  ///< a participant's model and initial state (a bed may have to be packed)
  double stall_s = 60.0;     ///< without progress in a window; without any sign of life in the set-up
  double farewell_s = 60.0;  ///< closing output
};

/// Every wait watches the wire, the processes and the user's signals together; the first failure seen is thrown as
/// ParticipantError: a participant's own Fault (its text, its code), its death (code or signal, last words of its log),
/// its loss on the wire, or its standing still. Not thread safe.
class Supervisor {
 public:
  /// Both must outlive the object.
  Supervisor(Children& children, proto::CouplerEndpoint& endpoint, const Patience& patience);

  /// Names a participant that was started.
  void add(const std::string& name, const std::string& program, const std::string& log_path);
  /// Names a participant that somebody else starts and that connects to `address`: it has no process here to watch.
  void expect(const std::string& name, const std::string& address);

  /// What the run is doing, for messages: "window 37".
  void set_stage(std::string stage) { stage_ = std::move(stage); }
  const std::string& stage() const { return stage_; }

  /// True: a stop signal ends any wait by Interrupted. False: only the second one does; the caller looks at
  /// stop_requested() between windows.
  void set_interruptible(bool interruptible) { interruptible_ = interruptible; }
  int stop_requested() const { return children_.stop_signal(); }

  /// Is told every ten seconds of a set-up what is waited for and what that participant wrote last.
  void on_long_set_up(std::function<void(const std::string&)> tell) { tell_ = std::move(tell); }

  /// Is told of everybody whom the endpoint turns away; the same text in a row once.
  void on_turned_away(std::function<void(const std::string&)> tell) { tell_turned_away_ = std::move(tell); }

  /// Waits for the Hello of every participant.
  std::map<std::string, proto::Hello> await_hellos();

  /// Sends without waiting; the returned number identifies the answer.
  std::uint64_t send(const std::string& name, proto::Body body);

  /// Waits for the next message of `name`, which must be a T and the answer to `in_reply_to` (0: to what the endpoint
  /// sent by itself).
  /// `set_up`: judge it by the set-up's patience.
  template <class T>
  T await(const std::string& name, std::uint64_t in_reply_to, bool set_up = false);

  /// Sends Finish to all, waits for every Bye and for every process that was started here to exit with code 0. Facts
  /// in order of name.
  std::vector<proto::Fact> finish();

  /// Tells the participants that the run failed and gives them a moment to go by themselves.
  void abandon(int code, const std::string& text) noexcept;

  double waited_s() const { return waited_s_; }  ///< wall time spent in waits so far

  /// Text about the last sender that the endpoint turned away; "" if none.
  const std::string& turned_away() const { return turned_away_; }

 private:
  struct Known {
    std::string program, log_path;  ///< of one that is awaited: where it is awaited, none
    bool awaited = false;
    bool connected = false, finished = false;
    proto::Hello hello;
    std::deque<proto::Message> inbox;
  };
  void pump(double timeout_s);
  void take(const proto::EndpointEvent& event);
  void check_signals() const;
  void check_exits();
  std::string where_to_look(const Known& known) const;
  void report_death(const std::string& name, const ChildExit& exit);
  void report_loss(const proto::EndpointEvent& event);
  void check_pulse(const std::string& name, bool set_up, double waited_s);
  proto::Message next(const std::string& name, bool set_up);
  [[noreturn]] void refuse(const std::string& name, const proto::Message& message, const char* wanted);

  Children& children_;
  proto::CouplerEndpoint& endpoint_;
  Patience patience_;
  std::map<std::string, Known> known_;
  std::string stage_ = "start-up", turned_away_;
  std::function<void(const std::string&)> tell_, tell_turned_away_;
  bool interruptible_ = true;
  double waited_s_ = 0.0;
};

template <class T>
T Supervisor::await(const std::string& name, std::uint64_t in_reply_to, bool set_up) {
  const char* wanted = proto::name_of(proto::Body(T{}));
  auto message = next(name, set_up);
  const bool answers = in_reply_to == 0 || message.in_reply_to == in_reply_to;
  if (!answers || !std::holds_alternative<T>(message.body)) refuse(name, message, wanted);
  return std::get<T>(std::move(message.body));
}

}  // namespace coupler
