// The participant as a process: signs of life, farewell, and an end whenever the run ends.
#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

#include "coupler/conformance/check.hpp"
#include "coupler/conformance/subject.hpp"

namespace coupler::conformance {
namespace {

constexpr double silence_limit_s = 1.0;  // ten heartbeats
constexpr double long_window_s = 1.5;    // computing, to see heartbeats meanwhile
constexpr double end_limit_s = 2.0;
constexpr auto unavailable_code = static_cast<int>(proto::ExitCode::unavailable);

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// What the heartbeats were like while windows were computed.
struct Pulses {
  double longest_silence_s = 0.0, longest_window_s = 0.0;
  std::uint64_t n_progress = 0;  ///< changes of the count in the longest window

  void watch(Subject& subject, const proto::Advance& request) {
    auto last = subject.pulse().progress;
    std::uint64_t n_changes = 0;
    const double begin = now_s();
    subject.solve(request, [&] {
      const auto pulse = subject.pulse();
      longest_silence_s = std::max(longest_silence_s, pulse.silent_s);
      n_changes += pulse.progress != last;
      last = pulse.progress;
    });
    subject.commit();
    if (now_s() - begin < longest_window_s) return;
    longest_window_s = now_s() - begin;
    n_progress = n_changes;
  }
};

/// Windows of more and more sub-cycles until one takes `long_window_s`, at most for `limit_s`.
Pulses watched_windows(Subject& subject, double limit_s) {
  constexpr double most_sub_cycles = 1e9;
  Pulses pulses;
  double factor = 1.0;
  for (const double begin = now_s(); pulses.longest_window_s < long_window_s && now_s() - begin < limit_s;) {
    auto request = subject.request();
    const double sub_cycles = std::min(most_sub_cycles, factor * request.sub_cycles);
    request.sub_cycles = static_cast<std::uint32_t>(sub_cycles);
    pulses.watch(subject, request);
    factor *= std::clamp(1.3 * long_window_s / pulses.longest_window_s, 1.0, 100.0);
  }
  return pulses;
}

Verdict heartbeats(Bench& bench) {
  Subject subject(bench);
  subject.bring_to(Stage::marching);
  const auto before = subject.pulse().progress;
  const auto pulses = watched_windows(subject, bench.candidate().is_explicit() ? 6.0 : 1.0);
  if (pulses.longest_silence_s > silence_limit_s)
    return fail(fmt::format("silent for {:.2f} s in a window of {:.2f} s; a heartbeat was due every {} s",
                            pulses.longest_silence_s, pulses.longest_window_s, Subject::heartbeat_s));
  if (const auto end = subject.ending(1.2 * silence_limit_s); end.exit)
    return fail("asked for nothing, it " + end.text());
  if (const double silent_s = subject.pulse().silent_s; silent_s > silence_limit_s)
    return fail(fmt::format("silent for {:.2f} s between windows", silent_s));
  const bool long_enough = pulses.longest_window_s >= long_window_s;
  const bool counted = long_enough ? pulses.n_progress > 1 : subject.pulse().progress != before;
  if (!counted) return fail("the heartbeats do not count the work: 'progress' stands still");
  return pass(fmt::format("longest silence {:.2f} s, longest window {:.2f} s{}", pulses.longest_silence_s,
                          pulses.longest_window_s, long_enough ? "" : " (too short to tell computing from waiting)"));
}

Verdict farewell(Bench& bench) {
  for (const auto stage : {Stage::configured, Stage::marching}) {
    Subject subject(bench);
    subject.bring_to(stage);
    if (stage == Stage::marching) subject.march(2);
    for (const auto& fact : subject.finish())
      if (fact.key.empty()) return fail("a fact without a key");
    if (const auto end = subject.ending(end_limit_s); !end.exit || end.exit->signal || end.exit->code)
      return fail("after Bye it " + end.text());
  }
  return pass();
}

/// A participant in a window that takes longer than anybody waits.
void begin_endless_window(Subject& subject) {
  auto request = subject.request();
  request.sub_cycles = std::numeric_limits<std::uint32_t>::max();
  subject.send(request);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
}

/// Ends the run by `stop` in the middle of the march and in the middle of a window.
template <class Stop>
Verdict ends_after(Bench& bench, const char* what, Stop stop) {
  double longest = 0.0;
  for (const bool computing : {false, true}) {
    Subject subject(bench);
    subject.bring_to(Stage::marching);
    subject.march(1);
    if (computing) begin_endless_window(subject);
    stop(subject);
    const auto end = subject.ending(end_limit_s);
    const auto when = fmt::format("{}{}: ", what, computing ? " while it computes" : "");
    if (!end.exit) return fail(when + end.text());
    if (end.exit->signal || end.exit->code != unavailable_code)
      return fail(fmt::format("{}{}; code {} was expected", when, end.text(), unavailable_code));
    longest = std::max(longest, end.seconds);
  }
  return pass(fmt::format("gone after {:.2f} s at most", longest));
}

Verdict abort_by_fault(Bench& bench) {
  return ends_after(bench, "a Fault of the coupler", [](Subject& subject) {
    subject.send(proto::Fault{unavailable_code, "the other participant failed"});
  });
}

Verdict lost_coupler(Bench& bench) {
  return ends_after(bench, "the coupler is gone", [](Subject& subject) { subject.lose_coupler(); });
}

std::string what_a_kill_leaves(Bench& bench, const Settings& settings, Stage stage, bool computing) {
  Subject subject(bench, settings);
  subject.bring_to(stage);
  if (computing) begin_endless_window(subject);
  subject.kill_process();
  if (!subject.ending(end_limit_s).exit) return "it survives SIGKILL";
  const double begin = now_s();
  auto left = subject.processes();
  while (!left.empty() && now_s() - begin < 1.0) left = subject.processes();
  return left.empty() ? "" : fmt::format("{} processes that it started go on, {} among them", left.size(), left[0]);
}

Verdict kill_anywhere(Bench& bench) {
  const std::pair<Stage, const char*> moments[] = {{Stage::connected, "connected"},   {Stage::registered, "registered"},
                                                   {Stage::configured, "configured"}, {Stage::marching, "marching"},
                                                   {Stage::marching, "computing"},    {Stage::advanced, "advanced"}};
  Settings settings;
  settings.folder = bench.new_folder();  // the same for all: nothing may stand in the next one's way
  for (const auto& [stage, name] : moments)
    if (const auto left = what_a_kill_leaves(bench, settings, stage, std::string(name) == "computing"); !left.empty())
      return fail(fmt::format("killed in the state {}: {}", name, left));
  Subject next(bench, settings);
  next.bring_to(Stage::marching);
  return pass("six states; the next process starts in the same folder");
}

}  // namespace

std::vector<Check> process_checks() {
  return {{"heartbeats", "sends heartbeats that count its work while it computes", Role::both, heartbeats},
          {"farewell", "answers Finish by Bye and ends with code 0", Role::both, farewell},
          {"abort", "ends within 2 s when the coupler sends a Fault, in a window too", Role::both, abort_by_fault},
          {"lost_coupler", "ends within 2 s when the coupler is gone, in a window too", Role::both, lost_coupler},
          {"kill", "killed in any state it leaves no process and nothing that stops the next one", Role::both,
           kill_anywhere}};
}

}  // namespace coupler::conformance
