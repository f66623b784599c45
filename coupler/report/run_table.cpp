#include "coupler/report/run_table.hpp"

#include <fmt/format.h>

namespace coupler {
namespace {

std::string row(const std::string& what, const std::string& value) {
  return fmt::format("  {:<30}{}\n", what, value);
}

std::string seconds(double value, double total) {
  return fmt::format("{:>10.2f} s  {:>3.0f} %", value, total > 0.0 ? 100.0 * value / total : 0.0);
}

}  // namespace

std::string run_table(const Summary& s, const std::string& out) {
  std::string text = fmt::format("\n{}: {}, scheme {}, {} windows of {:g} s, up to {} sub-cycles\n", s.case_name,
                                 s.status, s.scheme, s.n_windows, s.window_s, s.sub_cycles);
  for (const auto& seat : s.seats) {
    text += fmt::format("rail seat '{}', largest along its normal\n", seat.name);
    text += row("seat force", fmt::format("{:>10.3f} kN", seat.max_force_n / 1e3));
    text += row("rail displacement", fmt::format("{:>10.4f} mm", seat.max_rail_displacement_m * 1e3));
    text += row("sleeper displacement", fmt::format("{:>10.4f} mm", seat.max_sleeper_displacement_m * 1e3));
  }
  text += "wall time\n";
  text += row("total", seconds(s.wall.total, s.wall.total));
  text += row("  start-up", seconds(s.wall.start_up, s.wall.total));
  text += row("  qdem computing", seconds(s.wall.qdem, s.wall.total));
  text += row("  fem computing", seconds(s.wall.fem, s.wall.total));
  text += row("  coupler", seconds(s.wall.coupler, s.wall.total));
  text += row("  waiting (transport, output)", seconds(s.wall.waiting, s.wall.total));
  text += "interface defects, relative\n";
  text += row("energy", fmt::format("{:>12.2e}", s.energy_defect_relative));
  text += row("momentum", fmt::format("{:>12.2e}", s.momentum_defect_relative));
  text += row("moment", fmt::format("{:>12.2e}", s.moment_defect_relative));
  text += "observed: " + s.observation.text() + "\n";
  text += fmt::format("results in {}\n", out);
  return text;
}

}  // namespace coupler
