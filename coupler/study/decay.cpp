// Modes from free decay.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupler/analysis/modes.hpp"
#include "coupler/study/analyses.hpp"

namespace coupler::study {
namespace {

constexpr std::size_t fewest_samples = 32;
constexpr double periods_wanted = 2;  // of a mode in the record
constexpr std::size_t shown = 3;      // modes of a record in the summary

/// A vertical velocity that may decay freely.
struct Decay {
  std::string name;
  double interval = 0.0;
  std::vector<double> time, velocity;
};

/// Mean over points of a motion.
std::vector<double> mean_velocity(const analysis::Motion& motion, const std::vector<std::size_t>& points) {
  std::vector<double> mean(motion.n_samples(), 0.0);
  for (const std::size_t point : points) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i] += motion.velocity[3 * (i * motion.n_points() + point) + 2] / static_cast<double>(points.size());
    }
  }
  return mean;
}

std::vector<Decay> decays_of(const Run& run, const Options& options) {
  std::vector<Decay> decays;
  if (run.bottom) {
    std::vector<std::size_t> all(run.bottom->n_points());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    decays.push_back({"bottom", run.bottom->interval, run.bottom->time, mean_velocity(*run.bottom, all)});
  } else {
    for (const auto& seat : run.files.seats()) {
      decays.push_back({"seat_" + seat.name, seat.interval, seat.time, seat.sleeper_velocity});
    }
  }
  for (const auto& point : run.files.points()) {
    Decay decay{"sensor_" + point.name, point.interval, point.time, {}};
    for (std::size_t i = 2; i < point.velocity.size(); i += 3) decay.velocity.push_back(point.velocity[i]);
    decays.push_back(std::move(decay));
  }
  if (!run.stones || !run.footprint) return decays;
  const auto bins = analysis::depth_bins(run.stones->place, *run.footprint, options.n_bins, options.reach);
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (bins[b].points.empty()) continue;
    decays.push_back({fmt::format("bin_{}", b + 1), run.stones->interval, run.stones->time,
                      mean_velocity(*run.stones, bins[b].points)});
  }
  return decays;
}

/// Where the decay begins unless the user says so: at the largest speed of the first record, after the peak of the load
/// if that is known.
double begin_of(const Run& run, const Options& options, const Decay& first) {
  if (options.decay_from) return *options.decay_from;
  const double peak = run.load ? run.load->time[run.load->peak] : 0.0;
  double begin = peak, largest = 0.0;
  for (std::size_t i = 0; i < first.time.size(); ++i) {
    if (first.time[i] < peak || !(std::abs(first.velocity[i]) > largest)) continue;
    largest = std::abs(first.velocity[i]), begin = first.time[i];
  }
  return begin;
}

Table mode_table(const std::string& name, const std::vector<analysis::Mode>& modes) {
  std::vector<double> frequency, damping, amplitude;
  for (const auto& mode : modes) {
    frequency.push_back(mode.frequency), damping.push_back(mode.damping), amplitude.push_back(mode.amplitude);
  }
  Table table{"modes_" + name, {}};
  table.add("frequency", "Hz", frequency);
  table.add("damping_ratio", "1", damping);
  table.add("amplitude", "m/s", amplitude);
  return table;
}

void add_decay(const Decay& decay, double begin, const Options& options, const std::string& group, Findings& findings) {
  const auto after = std::lower_bound(decay.time.begin(), decay.time.end(), begin - 0.5 * decay.interval);
  const auto first = static_cast<std::size_t>(after - decay.time.begin());
  const std::size_t n = decay.time.size() - first;
  if (n < fewest_samples) {
    findings.notes.push_back(fmt::format("modes of {}: {} samples after {:.4g} s are too few", decay.name, n, begin));
    return;
  }
  analysis::RealisationOptions realisation;
  realisation.highest_frequency = std::min(options.highest_mode, 0.4 / decay.interval);
  const proto::Span<const double> free(decay.velocity.data() + first, n);
  auto modes = analysis::eigensystem_realisation(free, decay.interval, realisation);
  const double lowest = periods_wanted / (decay.interval * static_cast<double>(n));
  modes.erase(std::remove_if(modes.begin(), modes.end(), [&](const auto& mode) { return mode.frequency < lowest; }),
              modes.end());
  for (std::size_t k = 0; k < std::min(shown, modes.size()); ++k) {
    const std::string name = fmt::format("{}, mode {}", decay.name, k + 1);
    findings.figures.push_back({group, name + ": frequency", modes[k].frequency, "Hz"});
    findings.figures.push_back({group, name + ": damping ratio", modes[k].damping, "1"});
  }
  findings.tables.push_back(mode_table(decay.name, modes));
}

}  // namespace

void add_modes(const Run& run, const Options& options, Findings& findings) {
  const auto decays = decays_of(run, options);
  if (decays.empty()) {
    findings.notes.push_back("modes: they need coupling.h5, or a sensor of kind \"bottom\", \"stone\" or \"stones\"");
    return;
  }
  const double begin = begin_of(run, options, decays.front());
  const double length = decays.front().time.back() - begin;
  const std::string group = fmt::format("modes from the decay after {:.4g} s, vertical velocity", begin);
  if (length > 0) findings.figures.push_back({group, "two periods in the record from", periods_wanted / length, "Hz"});
  for (const auto& decay : decays) add_decay(decay, begin, options, group, findings);
}

}  // namespace coupler::study
