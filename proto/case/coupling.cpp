#include "proto/case/coupling.hpp"

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace proto {
namespace {

constexpr double most_windows = 1e9;

std::uint64_t read_window_count(const Section& section, double window_s) {
  const double duration = section.number("duration_s", Range::positive());
  const double count = duration / window_s, whole = std::round(count);
  if (count > most_windows) section.fail("duration_s", "more than 1e9 windows are asked for", "check window_s");
  if (whole < 1.0 || std::abs(count - whole) > 1e-9 * whole)
    section.fail("duration_s", "the duration is not a whole number of windows", "give a multiple of window_s");
  return static_cast<std::uint64_t>(whole);
}

ParticipantSpec read_participant(const Section& section, const std::string& name) {
  const std::string key = name + "_command";
  ParticipantSpec spec{name, section.texts_or(key, {name + "_solver", "participant"})};
  if (spec.command.empty() || spec.command.front().empty())
    section.fail(key, "the command is empty", "give the program and its first arguments");
  return spec;
}

Initialise read_initialise(const Section& section, double window_s) {
  Initialise result;
  result.window_s = section.number_or("window_s", window_s, Range::positive());
  const auto count = [&](const char* key, int fallback, double lowest) {
    return static_cast<int>(section.integer_or(key, fallback, Range::between(lowest, 1e9)));
  };
  result.max_windows = count("max_windows", result.max_windows, 0);
  result.min_windows = count("min_windows", result.min_windows, 0);
  result.check_windows = count("check_windows", result.check_windows, 1);
  result.tolerance = section.number_or("tolerance", result.tolerance, Range::positive());
  result.force_floor = section.number_or("force_floor_n", result.force_floor, Range::not_negative());
  result.qdem_residual_limit = section.number_or("qdem_residual_limit", result.qdem_residual_limit, Range::positive());
  result.fem_residual_limit = section.number_or("fem_residual_limit", result.fem_residual_limit, Range::positive());
  if (result.min_windows > result.max_windows) section.fail("min_windows", "min_windows is greater than max_windows");
  if (result.max_windows > 0 && result.max_windows <= result.check_windows)
    section.fail("max_windows", "rest is judged over the last " + std::to_string(result.check_windows) + " windows",
                 "allow more than check_windows");
  return result;
}

CheckpointTimes read_checkpoint(const Section& section) {
  CheckpointTimes times;
  times.interval_windows = section.integer_or("interval_windows", 0, Range::between(0, most_windows));
  times.interval_s = section.number_or("interval_s", times.interval_s, Range::not_negative());
  return times;
}

}  // namespace

const std::vector<std::string>& scheme_names() {
  static const std::vector<std::string> names{"R1", "R2", "E1", "E2"};  // in the order of the enumeration
  return names;
}

const std::string& name_of(Scheme scheme) {
  return scheme_names()[static_cast<std::size_t>(scheme)];
}

Scheme scheme_of(const std::string& name) {
  const auto& names = scheme_names();
  return static_cast<Scheme>(std::find(names.begin(), names.end(), name) - names.begin());
}

bool uses_robin(Scheme scheme) {
  return scheme == Scheme::robin_explicit || scheme == Scheme::robin_corrected;
}

Coupling read_coupling(const CaseFile& file) {
  const auto section = file.section("coupling");
  Coupling coupling;
  coupling.scheme = scheme_of(section.choice_or("scheme", "R1", scheme_names()));
  coupling.window_s = section.number_or("window_s", coupling.window_s, Range::positive());
  coupling.n_windows = read_window_count(section, coupling.window_s);
  coupling.output_interval_s = section.number_or("output_interval_s", 0.0, Range::not_negative());
  coupling.connect_timeout_s = section.number_or("connect_timeout_s", coupling.connect_timeout_s, Range::positive());
  coupling.stall_timeout_s = section.number_or("stall_timeout_s", coupling.stall_timeout_s, Range::positive());
  coupling.qdem = read_participant(section, "qdem");
  coupling.fem = read_participant(section, "fem");
  coupling.initialise = read_initialise(section.section("initialise"), coupling.window_s);
  coupling.checkpoint = read_checkpoint(section.section("checkpoint"));
  section.finish();
  return coupling;
}

}  // namespace proto
