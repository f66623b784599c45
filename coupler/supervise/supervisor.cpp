#include "coupler/supervise/supervisor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "coupler/supervise/last_words.hpp"
#include "proto/clock.hpp"

namespace coupler {
namespace {

using Clock = std::chrono::steady_clock;
using proto::ExitCode;

constexpr double slice_s = 0.25;  // longest single wait; signals and exits wake it earlier

using proto::seconds_since;

/// The failure that an exit code of this house stands for; nothing for any other code, and for success.
std::optional<ExitCode> failure_of(int code) {
  constexpr ExitCode house[] = {ExitCode::usage,    ExitCode::bad_data, ExitCode::missing_input, ExitCode::unavailable,
                                ExitCode::internal, ExitCode::os_error, ExitCode::cannot_create, ExitCode::io_error,
                                ExitCode::numerics, ExitCode::protocol, ExitCode::config};
  for (const auto known : house)
    if (static_cast<int>(known) == code) return known;
  return std::nullopt;
}

/// A participant's exit code when it is one of this house's, else `unavailable`.
ExitCode run_code(int code) {
  return failure_of(code).value_or(ExitCode::unavailable);
}

/// A program's message without the program's name, which it puts before it.
std::string without_program(const std::string& words, const std::string& program) {
  const auto prefix = program.substr(program.rfind('/') + 1) + ": ";
  return words.compare(0, prefix.size(), prefix) == 0 ? words.substr(prefix.size()) : words;
}

}  // namespace

Supervisor::Supervisor(Children& children, proto::CouplerEndpoint& endpoint, const Patience& patience)
    : children_(children), endpoint_(endpoint), patience_(patience) {}

void Supervisor::add(const std::string& name, const std::string& program, const std::string& log_path) {
  known_[name].program = program;
  known_[name].log_path = log_path;
}

void Supervisor::expect(const std::string& name, const std::string& address) {
  known_[name].program = "awaited at " + address;
  known_[name].awaited = true;
}

std::uint64_t Supervisor::send(const std::string& name, proto::Body body) {
  try {
    return endpoint_.send(name, std::move(body));
  } catch (const proto::Error& error) {
    // It cannot be reached; why is for its process to tell, if that has ended.
    const auto start = Clock::now();
    while (seconds_since(start) < 1.0) {
      pump(0.05);
      check_exits();
    }
    throw ParticipantError(name, error.code(), error.what());
  }
}

void Supervisor::pump(double timeout_s) {
  const auto start = Clock::now();
  const auto events = endpoint_.wait(timeout_s, children_.fd());
  children_.poll();
  waited_s_ += seconds_since(start);
  for (const auto& event : events) take(event);
}

void Supervisor::take(const proto::EndpointEvent& event) {
  if (event.participant.empty()) {
    if (tell_turned_away_ && event.problem != turned_away_) tell_turned_away_(event.problem);
    turned_away_ = event.problem;
    return;
  }
  auto& known = known_[event.participant];
  if (!event.message) {
    if (!known.finished) report_loss(event);
    return;
  }
  const auto& body = event.message->body;
  if (const auto* fault = std::get_if<proto::Fault>(&body))
    throw ParticipantError(event.participant, run_code(fault->code), event.participant + ": " + fault->text, stage_);
  if (const auto* hello = std::get_if<proto::Hello>(&body)) {
    known.connected = true;
    known.hello = *hello;
    return;
  }
  // After its Bye a participant may go when it likes.
  if (std::holds_alternative<proto::Bye>(body)) known.finished = true;
  known.inbox.push_back(*event.message);
}

void Supervisor::check_signals() const {
  if (children_.n_stop_signals() > (interruptible_ ? 0 : 1)) throw Interrupted(children_.stop_signal());
}

void Supervisor::check_exits() {
  for (const auto& [name, known] : known_) {
    const auto exit = children_.exit_of(name);
    if (exit && !known.finished) report_death(name, *exit);
  }
}

std::string Supervisor::where_to_look(const Known& known) const {
  return known.awaited ? "see what it wrote where it was started" : "see " + known.log_path;
}

void Supervisor::report_death(const std::string& name, const ChildExit& exit) {
  // A fault it sent before it went says more than its exit code; take() throws it. Who went with 0 has said Bye, and on
  // a busy machine that takes its time.
  const auto start = Clock::now();
  const double patience_s = exit.code == 0 && exit.signal == 0 ? 2.0 : 0.2;
  while (seconds_since(start) < patience_s && !known_.at(name).finished)
    for (const auto& event : endpoint_.wait(0.05))
      if (event.message) take(event);
  const auto& known = known_.at(name);
  // Its Bye was still on the wire when the kernel told of its exit: it went as it should.
  if (known.finished && exit.code == 0 && exit.signal == 0) return;
  const auto words = last_words(known.log_path);
  const auto end = fmt::format("{} in {}{}", exit.text(), stage_, known.connected ? "" : ", before it connected");
  const auto program = fmt::format("{} ({})", name, known.program), log = "see " + known.log_path;
  // One that failed as this house's programs do has said why; of any other it is only known how it ended.
  if (exit.signal == 0 && failure_of(exit.code) && !words.empty())
    throw ParticipantError(name, run_code(exit.code), name + ": " + without_program(words, known.program),
                           program + " " + end, log);
  const bool turned_away = !known.connected && !turned_away_.empty();
  const auto why = turned_away ? turned_away_ : words.empty() ? "" : "its last words: " + words;
  throw ParticipantError(name, exit.signal ? ExitCode::unavailable : run_code(exit.code), program + " " + end, why,
                         log);
}

void Supervisor::report_loss(const proto::EndpointEvent& event) {
  // A lost connection is mostly the shadow of an exit that the kernel is about to report.
  const auto start = Clock::now();
  const auto& known = known_.at(event.participant);
  const bool may_have_exited = !known.awaited && event.code == static_cast<int>(ExitCode::unavailable);
  while (may_have_exited && seconds_since(start) < 1.0) {
    children_.wait(0.05);
    if (const auto exit = children_.exit_of(event.participant)) return report_death(event.participant, *exit);
  }
  throw ParticipantError(event.participant, run_code(event.code),
                         fmt::format("{} ({}): {}", event.participant, known.program, event.problem), stage_,
                         where_to_look(known));
}

void Supervisor::check_pulse(const std::string& name, bool set_up, double waited_s) {
  const auto pulse = endpoint_.pulse(name);
  const auto& known = known_.at(name);
  const double still_s = set_up ? pulse.silent_s : pulse.progress_age_s;
  if (still_s > patience_.stall_s)
    throw ParticipantError(name, ExitCode::unavailable,
                           fmt::format("{} ({}) hangs: its process{} is alive, but {} for {:.0f} s", name,
                                       known.program, known.awaited ? "" : fmt::format(" {}", children_.pid_of(name)),
                                       set_up ? "gave no sign of life" : "made no progress", still_s),
                           stage_, "raise coupling.stall_timeout_s if it was only slow");
  if (set_up && waited_s > patience_.set_up_s)
    throw ParticipantError(name, ExitCode::unavailable,
                           fmt::format("{} ({}) was not ready after {:.0f} s", name, known.program, waited_s), stage_);
}

std::map<std::string, proto::Hello> Supervisor::await_hellos() {
  const auto start = Clock::now();
  for (;;) {
    std::map<std::string, proto::Hello> hellos;
    std::string missing;
    for (const auto& [name, known] : known_)
      if (known.connected)
        hellos[name] = known.hello;
      else
        missing += (missing.empty() ? "" : " and ") + fmt::format("{} ({})", name, known.program);
    if (missing.empty()) return hellos;
    if (seconds_since(start) > patience_.connect_s)
      throw ParticipantError(missing.substr(0, missing.find(' ')), ExitCode::unavailable,
                             fmt::format("{} did not connect within {:g} s", missing, patience_.connect_s),
                             turned_away_.empty() ? stage_ : "turned away: " + turned_away_,
                             "raise coupling.connect_timeout_s if it was only slow");
    pump(slice_s);
    check_signals();
    check_exits();
  }
}

proto::Message Supervisor::next(const std::string& name, bool set_up) {
  const auto start = Clock::now();
  auto& inbox = known_.at(name).inbox;
  double told_s = 0.0;
  while (inbox.empty()) {
    pump(slice_s);
    check_signals();
    check_exits();
    if (set_up && tell_ && seconds_since(start) - told_s > 10.0) {
      told_s = seconds_since(start);
      tell_(fmt::format("{} is setting up ({:.0f} s): {}", name, told_s, last_words(known_.at(name).log_path)));
    }
    if (inbox.empty()) check_pulse(name, set_up, seconds_since(start));
  }
  auto message = std::move(inbox.front());
  inbox.pop_front();
  return message;
}

void Supervisor::refuse(const std::string& name, const proto::Message& message, const char* wanted) {
  throw ParticipantError(name, ExitCode::protocol,
                         fmt::format("{} sent {} (in reply to {}) where {} was due", name, proto::name_of(message.body),
                                     message.in_reply_to, wanted),
                         stage_, "see proto/README.md for the order of messages");
}

std::vector<proto::Fact> Supervisor::finish() {
  set_stage("the end of the run");
  std::map<std::string, std::uint64_t> asked;
  for (const auto& entry : known_) asked[entry.first] = send(entry.first, proto::Finish{});
  std::vector<proto::Fact> facts;
  const auto start = Clock::now();
  for (const auto& [name, known] : known_) {
    auto bye = await<proto::Bye>(name, asked[name]);
    facts.insert(facts.end(), bye.facts.begin(), bye.facts.end());
  }
  while (children_.running() && seconds_since(start) < patience_.farewell_s) children_.wait(slice_s);
  for (const auto& [name, known] : known_) {
    if (known.awaited) continue;
    const auto exit = children_.exit_of(name);
    if (!exit)
      throw ParticipantError(name, ExitCode::unavailable,
                             fmt::format("{} ({}) said Bye and did not exit", name, known.program), stage_);
    if (exit->code != 0 || exit->signal != 0) report_death(name, *exit);
  }
  return facts;
}

void Supervisor::abandon(int code, const std::string& text) noexcept {
  for (const auto& [name, known] : known_) {
    if (!known.connected || known.finished || children_.exit_of(name)) continue;
    try {
      endpoint_.send(name, proto::Fault{code, text});
    } catch (const proto::Error&) {
      // It cannot be told any more; the signals that follow reach it.
    }
  }
  const auto start = Clock::now();
  while (children_.running() && seconds_since(start) < 0.7) children_.wait(0.05);
}

}  // namespace coupler
