// How far the sleeper goes down under repeated load.
#include <algorithm>

#include "coupler/analysis/cycles.hpp"
#include "coupler/analysis/statistics.hpp"
#include "coupler/study/analyses.hpp"

namespace coupler::study {
namespace {

constexpr std::size_t fewest_cycles = 2;

/// Downward displacement of the bottom at `time`, mean over its cells [m].
double depth_at(const analysis::Motion& bottom, double time) {
  const auto after = std::lower_bound(bottom.time.begin(), bottom.time.end(), time - 0.5 * bottom.interval);
  const auto row = std::min<std::size_t>(static_cast<std::size_t>(after - bottom.time.begin()), bottom.n_samples() - 1);
  double sum = 0.0;
  for (std::size_t point = 0; point < bottom.n_points(); ++point) {
    sum += bottom.displacement[3 * (row * bottom.n_points() + point) + 2];
  }
  return -sum / static_cast<double>(bottom.n_points());
}

}  // namespace

void add_settlement(const Run& run, const Options&, Findings& findings) {
  if (!run.load) return;
  const auto cycles = analysis::load_cycles(run.load->force);
  if (cycles.size() < fewest_cycles) return;
  if (!run.bottom) {
    findings.notes.push_back("settlement: it needs a sensor of kind \"bottom\"");
    return;
  }
  std::vector<double> number, loaded, unloaded, stiffness;
  for (const auto& cycle : cycles) {
    number.push_back(static_cast<double>(number.size() + 1));
    loaded.push_back(depth_at(*run.bottom, run.load->time[cycle.peak]));
    unloaded.push_back(depth_at(*run.bottom, run.load->time[cycle.trough]));
    stiffness.push_back((run.load->force[cycle.peak] - run.load->force[cycle.trough]) /
                        (loaded.back() - unloaded.back()));
  }
  const std::string group = "settlement under repeated load, sleeper bottom";
  const std::size_t half = cycles.size() / 2;
  findings.figures.push_back({group, "cycles", number.back(), "1"});
  findings.figures.push_back({group, "unloaded, after the first cycle", unloaded.front(), "m"});
  findings.figures.push_back({group, "unloaded, after the last cycle", unloaded.back(), "m"});
  findings.figures.push_back({group, "from the first cycle to the last", unloaded.back() - unloaded.front(), "m"});
  findings.figures.push_back(
      {group, "mean of a cycle in the second half",
       analysis::fitted_line({&number[half], number.size() - half}, {&unloaded[half], number.size() - half}).slope,
       "m"});
  findings.figures.push_back({group, "unloading stiffness of the last cycle", stiffness.back(), "N/m"});
  Table table{"settlement", {}};
  table.add("cycle", "1", number);
  table.add("unloaded", "m", unloaded), table.add("loaded", "m", loaded);
  table.add("unloading_stiffness", "N/m", stiffness);
  findings.tables.push_back(std::move(table));
}

}  // namespace coupler::study
