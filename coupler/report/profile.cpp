#include "coupler/report/profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace coupler {
namespace {

/// From this window's begin to the next one's; a run that was resumed begins its clock anew.
double period(const std::vector<WindowTimes>& windows, std::size_t i) {
  const auto& window = windows[i];
  const bool followed = i + 1 < windows.size() && windows[i + 1].begin >= window.end;
  return (followed ? windows[i + 1].begin : window.end) - window.begin;
}

std::string row(const char* who, double compute, double wall) {
  const double wait = std::max(0.0, wall - compute);
  return fmt::format("{:<8}{:>12.3f}{:>12.3f}{:>11.1f} %\n", who, compute, wait,
                     wall > 0.0 ? 100.0 * compute / wall : 0.0);
}

nlohmann::json slice(const std::string& name, int track, double begin, double duration) {
  return {{"name", name}, {"ph", "X"}, {"pid", 1}, {"tid", track}, {"ts", 1e6 * begin}, {"dur", 1e6 * duration}};
}

}  // namespace

Profile profile_of(const std::vector<WindowTimes>& windows, bool at_once) {
  Profile profile;
  profile.n_windows = windows.size();
  std::vector<double> transports;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto& window = windows[i];
    const double computing = at_once ? std::max(window.qdem, window.fem) : window.qdem + window.fem;
    transports.push_back(std::max(0.0, window.end - window.begin - computing));
    profile.wall += period(windows, i);
    profile.between += period(windows, i) - (window.end - window.begin);
    profile.qdem_compute += window.qdem;
    profile.fem_compute += window.fem;
    profile.transport += transports.back();
  }
  if (transports.empty()) return profile;
  std::sort(transports.begin(), transports.end());
  profile.transport_least = transports.front();
  profile.transport_median = transports[transports.size() / 2];
  return profile;
}

std::string profile_table(const Profile& profile) {
  auto text = fmt::format("{} windows in {:.3f} s\n\n{:<8}{:>12}{:>12}{:>13}\n", profile.n_windows, profile.wall, "",
                          "compute s", "wait s", "computing");
  text += row("qdem", profile.qdem_compute, profile.wall) + row("fem", profile.fem_compute, profile.wall);
  text += fmt::format(
      "\ncoupler and transport within windows  {:.3f} s, {:.3f} ms a window (median), {:.3f} ms (least)\n"
      "between windows (commit, record, output)  {:.3f} s\n",
      profile.transport, 1e3 * profile.transport_median, 1e3 * profile.transport_least, profile.between);
  return text;
}

std::string trace_json(const std::vector<WindowTimes>& windows) {
  auto events = nlohmann::json::array();
  const char* tracks[] = {"windows", "fem", "qdem"};
  for (int track = 0; track < 3; ++track)
    events.push_back(
        {{"name", "thread_name"}, {"ph", "M"}, {"pid", 1}, {"tid", track}, {"args", {{"name", tracks[track]}}}});
  double offset = 0.0, last = 0.0;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto& window = windows[i];
    if (window.begin + offset < last) offset = last - window.begin;  // a resumed run goes on where the other ended
    const auto name = fmt::format("window {}", i);
    events.push_back(slice(name, 0, offset + window.begin, window.end - window.begin));
    events.push_back(slice(name, 1, offset + window.begin, window.fem));
    events.push_back(slice(name, 2, offset + window.end - window.qdem, window.qdem));
    last = offset + window.end;
  }
  return nlohmann::json{{"traceEvents", events}, {"displayTimeUnit", "ms"}}.dump() + "\n";
}

}  // namespace coupler
