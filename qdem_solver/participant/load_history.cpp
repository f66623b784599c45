#include "qdem_solver/participant/load_history.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace qdem {
namespace {

using proto::Range;
using proto::Section;

LoadHistory read_table(const Section& section) {
  const auto time = section.numbers("time_s", 0, Range::not_negative());
  const auto force = section.numbers("force_n");
  if (time.size() != force.size() || time.empty()) {
    section.fail("force_n", std::to_string(force.size()) + " forces for " + std::to_string(time.size()) + " times",
                 "give as many forces as time_s has times");
  }
  if (std::adjacent_find(time.begin(), time.end(), std::greater_equal<>()) != time.end()) {
    section.fail("time_s", "the times do not ascend");
  }
  return [time, force](double t) {
    const auto next = std::upper_bound(time.begin(), time.end(), t) - time.begin();
    if (next == 0) return force.front();
    if (next == static_cast<std::ptrdiff_t>(time.size())) return force.back();
    const double share = (t - time[next - 1]) / (time[next] - time[next - 1]);
    return force[next - 1] + share * (force[next] - force[next - 1]);
  };
}

LoadHistory read_half_sine(const Section& section) {
  const double peak = section.number("peak_n"), duration = section.number("duration_s", Range::positive());
  const double start = section.number_or("start_s", 0.0, Range::not_negative());
  return [=](double t) {
    const double share = (t - start) / duration;
    return share > 0 && share < 1 ? peak * std::sin(M_PI * share) : 0.0;
  };
}

LoadHistory read_cyclic(const Section& section) {
  const double mean = section.number("mean_n"), amplitude = section.number("amplitude_n");
  const double frequency = section.number("frequency_hz", Range::positive());
  const double cycles = section.number("cycles", Range::positive());
  const double start = section.number_or("start_s", 0.0, Range::not_negative());
  return [=](double t) {
    if (t < start) return mean * t / start;
    const double phase = std::min((t - start) * frequency, cycles);
    return mean + amplitude * std::sin(2 * M_PI * phase);
  };
}

}  // namespace

LoadHistory read_load(const Section& section) {
  const std::string kind = section.choice_or("kind", "none", {"none", "table", "half_sine", "cyclic"});
  if (kind == "table") return read_table(section);
  if (kind == "half_sine") return read_half_sine(section);
  if (kind == "cyclic") return read_cyclic(section);
  return {};
}

}  // namespace qdem
