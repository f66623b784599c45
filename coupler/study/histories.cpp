// Histories and their spectra; the load.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "coupler/study/analyses.hpp"
#include "coupler/study/records.hpp"

namespace coupler::study {
namespace {

constexpr std::size_t fewest_samples = 32;  // for a spectral centre

/// Mean over the points of [n][points][3] values.
std::vector<double> mean_over_points(const std::vector<double>& values, std::size_t n_points) {
  std::vector<double> result(values.size() / n_points, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    result[3 * (i / (3 * n_points)) + i % 3] += values[i] / static_cast<double>(n_points);
  }
  return result;
}

std::vector<Table::Column> motion_columns(const std::vector<double>& displacement,
                                          const std::vector<double>& velocity) {
  auto columns = components("displacement", "m", displacement);
  for (auto& column : components("velocity", "m/s", velocity)) columns.push_back(std::move(column));
  return columns;
}

std::vector<double> rows_of(const analysis::Motion& motion, const std::vector<double>& values, std::size_t point) {
  std::vector<double> result;
  for (std::size_t i = 0; i < motion.n_samples(); ++i) {
    const double* row = &values[3 * (i * motion.n_points() + point)];
    result.insert(result.end(), row, row + 3);
  }
  return result;
}

std::size_t nearest_point(const analysis::Motion& motion, const std::array<double, 3>& wanted) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < motion.n_points(); ++i) {
    const auto& p = motion.place[i];
    const double distance = std::hypot(p[0] - wanted[0], p[1] - wanted[1], p[2] - wanted[2]);
    if (distance < least) least = distance, nearest = i;
  }
  return nearest;
}

void add_chosen(const Run& run, const Options& options, Findings& findings) {
  if (options.chosen.empty()) return;
  if (!run.stones) {
    findings.notes.push_back("chosen stones: they need a sensor of kind \"stones\" in the case");
    return;
  }
  const analysis::Motion& stones = *run.stones;
  std::set<std::size_t> numbers;
  for (const auto& wanted : options.chosen) numbers.insert(nearest_point(stones, wanted));
  for (const std::size_t stone : numbers) {
    const std::string name = fmt::format("stone_{}", stone);
    add_record(name, stones.time, stones.interval,
               motion_columns(rows_of(stones, stones.displacement, stone), rows_of(stones, stones.velocity, stone)),
               options, findings);
    for (int c = 0; c < 3; ++c) {
      findings.figures.push_back({"chosen stones", fmt::format("{}: {}", name, "xyz"[c]), stones.place[stone][c], "m"});
    }
  }
}

/// Mean frequency of the power of the bottom's vertical velocity in rows [first, last) [Hz].
double spectral_centre(const analysis::Motion& bottom, std::size_t first, std::size_t last) {
  double moment = 0.0, sum = 0.0;
  const analysis::Segmentation cut{last - first, 0, analysis::Window::hann};
  for (std::size_t cell = 0; cell < bottom.n_points(); ++cell) {
    const auto velocity = bottom.history(bottom.velocity, cell, 2);
    const auto spectra = analysis::segment_transforms({velocity.data() + first, last - first}, bottom.interval, cut);
    const auto density = analysis::power_density(spectra);
    for (std::size_t k = 0; k < density.size(); ++k) moment += spectra.frequency[k] * density[k], sum += density[k];
  }
  return moment / sum;
}

}  // namespace

void add_histories(const Run& run, const Options& options, Findings& findings) {
  for (const auto& seat : run.files.seats()) {
    add_record("seat_" + seat.name, seat.time, seat.interval,
               {{"force_on_sleeper", "N", seat.force},
                {"rail_displacement", "m", seat.rail},
                {"sleeper_displacement", "m", seat.sleeper},
                {"sleeper_velocity", "m/s", seat.sleeper_velocity}},
               options, findings);
  }
  if (run.bottom) {
    const auto& bottom = *run.bottom;
    add_record("bottom", bottom.time, bottom.interval,
               motion_columns(mean_over_points(bottom.displacement, bottom.n_points()),
                              mean_over_points(bottom.velocity, bottom.n_points())),
               options, findings);
  }
  for (const auto& point : run.files.points()) {
    auto columns = motion_columns(point.displacement, point.velocity);
    for (auto& column : components("acceleration", "m/s2", point.acceleration)) columns.push_back(std::move(column));
    add_record("sensor_" + point.name, point.time, point.interval, columns, options, findings);
  }
  add_chosen(run, options, findings);
}

void add_load(const Run& run, const Options&, Findings& findings) {
  if (!run.load) {
    findings.notes.push_back("load: it needs coupling.h5, or a sensor of kind \"pressure\"");
    return;
  }
  const Load& load = *run.load;
  const std::string group = "load, " + load.source;
  findings.figures.push_back({group, "largest", load.force[load.peak], "N"});
  findings.figures.push_back({group, "at", load.time[load.peak], "s"});
  findings.figures.push_back({group, "least after it", load.force[load.unloaded], "N"});
  findings.figures.push_back({group, "at that time", load.time[load.unloaded], "s"});
  if (!run.bottom) return;
  const auto& bottom = *run.bottom;
  const auto at = std::lower_bound(bottom.time.begin(), bottom.time.end(), load.time[load.peak]);
  const auto row = static_cast<std::size_t>(at - bottom.time.begin());
  if (row < fewest_samples || row + fewest_samples > bottom.n_samples()) {
    findings.notes.push_back(fmt::format(
        "loading and unloading: fewer than {} samples before or after the peak of the load", fewest_samples));
    return;
  }
  const double before = spectral_centre(bottom, 0, row), after = spectral_centre(bottom, row, bottom.n_samples());
  findings.figures.push_back({group, "mean frequency of the bottom's velocity before the peak", before, "Hz"});
  findings.figures.push_back({group, "the same after the peak", after, "Hz"});
}

}  // namespace coupler::study
