#include "coupler/report/status_view.hpp"

#include <fmt/format.h>

#include "coupler/report/progress.hpp"

namespace coupler {
namespace {

std::string windows_text(const RunStatus& s) {
  const double share =
      s.n_windows_wanted > 0 ? static_cast<double>(s.n_windows) / static_cast<double>(s.n_windows_wanted) : 0.0;
  return fmt::format("{} of {} windows ({:.0f} %), {:.5g} s simulated", s.n_windows, s.n_windows_wanted, 100.0 * share,
                     s.simulated_s);
}

std::string pace_text(const RunStatus& s) {
  return fmt::format("{:.3g} windows/s, {} left", s.windows_per_s, duration_text(s.left_s));
}

std::string defects_text(const RunStatus& s) {
  return fmt::format("{:.1e} (energy) {:.1e} (momentum)", s.energy_defect_relative, s.momentum_defect_relative);
}

double share_of_march(const WallTime& wall, double value) {
  const double marched = wall.total - wall.start_up;
  return marched > 0.0 ? 100.0 * value / marched : 0.0;
}

std::string row(const char* what, const std::string& value) {
  return fmt::format("  {:<14}{}\n", what, value);
}

}  // namespace

std::string wait_text(const WallTime& wall) {
  return fmt::format("waits {:.0f} %", share_of_march(wall, wall.waiting));
}

std::string status_block(const RunStatus& s) {
  std::string text = fmt::format("{}: {}, scheme {}, {}\n", s.case_name, s.status, s.scheme, s.phase);
  if (!s.note.empty()) text += row("note", s.note);
  if (s.n_windows_wanted > 0) {
    text += row("done", windows_text(s));
    text += row("pace", pace_text(s));
  }
  for (const auto& seat : s.seats)
    text += row("seat force", fmt::format("{:.3f} kN ({})", seat.force_n / 1e3, seat.name));
  if (s.phase == "marching") text += row("defects", defects_text(s));
  text += row("wall time", fmt::format("{}, start-up {}", duration_text(s.wall.total), duration_text(s.wall.start_up)));
  if (s.n_windows > 0)
    text += row("of it", fmt::format("qdem {:.0f} %, fem {:.0f} %, coupler {:.0f} %, {}",
                                     share_of_march(s.wall, s.wall.qdem), share_of_march(s.wall, s.wall.fem),
                                     share_of_march(s.wall, s.wall.coupler), wait_text(s.wall)));
  return text;
}

std::string status_line(const RunStatus& s) {
  std::string text = fmt::format("{}: {}, {}", s.case_name, s.status, s.phase);
  if (s.n_windows_wanted > 0) text += "  " + windows_text(s) + "  " + pace_text(s);
  for (const auto& seat : s.seats) text += fmt::format("  {} {:.2f} kN", seat.name, seat.force_n / 1e3);
  if (s.phase == "marching") text += "  defects " + defects_text(s);
  if (s.n_windows > 0) text += "  " + wait_text(s.wall);
  return s.note.empty() ? text : text + "  " + s.note;
}

}  // namespace coupler
