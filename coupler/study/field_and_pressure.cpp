// The layer at the peak of the load: displacement of all stones, pressure under the sleeper, stress in the stones.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupler/analysis/statistics.hpp"
#include "coupler/study/analyses.hpp"
#include "coupler/study/stone_mesh.hpp"

namespace coupler::study {
namespace {

constexpr std::size_t n_distance_bins = 8;

std::size_t nearest_row(const std::vector<double>& time, double wanted) {
  const auto after = std::lower_bound(time.begin(), time.end(), wanted);
  const auto row = static_cast<std::size_t>(after - time.begin());
  if (row == time.size()) return row - 1;
  return row > 0 && wanted - time[row - 1] < time[row] - wanted ? row - 1 : row;
}

/// All stones at one instant.
struct Snapshot {
  double time = 0.0;
  std::vector<std::array<double, 3>> place;
  std::vector<double> displacement;  ///< [stones][3]
};

/// At the peak of the load, from the sensor if there is one, else from the output nearest to it.
std::optional<Snapshot> snapshot_at_peak(const Run& run, Findings& findings) {
  if (!run.load) {
    findings.notes.push_back("displacement field: no load is known whose peak could be taken");
    return std::nullopt;
  }
  const double peak = run.load->time[run.load->peak];
  if (run.stones) {
    const auto& stones = *run.stones;
    const std::size_t row = nearest_row(stones.time, peak), length = 3 * stones.n_points();
    const auto first = stones.displacement.begin() + static_cast<std::ptrdiff_t>(row * length);
    return Snapshot{stones.time[row], stones.place, {first, first + static_cast<std::ptrdiff_t>(length)}};
  }
  const auto& qdem = run.files.qdem();
  if (!qdem || qdem->n_steps() == 0) {
    findings.notes.push_back(
        "displacement field: it needs a sensor of kind \"stones\", or output of the fields (qdem.h5)");
    return std::nullopt;
  }
  const auto times = qdem->read_rows("/VTKHDF/Steps/Values", qdem->n_steps()).values;
  const std::size_t step = nearest_row(times, peak);
  const StoneMesh mesh(*qdem);
  return Snapshot{times[step], mesh.places(), mesh.displacement(*qdem, step)};
}

Table field_table(const Snapshot& snapshot, const std::vector<double>& distance) {
  Table table{"displacement_field", {}};
  std::vector<double> number(distance.size()), size(distance.size());
  std::vector<double> place[3], displacement[3];
  for (std::size_t i = 0; i < distance.size(); ++i) {
    const double* u = &snapshot.displacement[3 * i];
    number[i] = static_cast<double>(i), size[i] = std::hypot(u[0], u[1], u[2]);
    for (int c = 0; c < 3; ++c) place[c].push_back(snapshot.place[i][c]), displacement[c].push_back(u[c]);
  }
  table.add("stone", "1", number);
  for (int c = 0; c < 3; ++c) table.add(std::string(1, "xyz"[c]), "m", place[c]);
  const char* const directions[] = {"longitudinal", "lateral", "vertical"};
  for (int c = 0; c < 3; ++c) table.add(directions[c], "m", displacement[c]);
  table.add("magnitude", "m", size);
  table.add("distance", "m", distance);
  return table;
}

/// Means of magnitudes in bins of the distance.
Table decay_table(const Table& field) {
  const auto& distance = field.columns.back().values;
  const double farthest = *std::max_element(distance.begin(), distance.end());
  Table table{"displacement_decay", {}};
  std::vector<double> middle(n_distance_bins), count(n_distance_bins, 0.0);
  for (std::size_t b = 0; b < n_distance_bins; ++b) {
    middle[b] = farthest * (static_cast<double>(b) + 0.5) / static_cast<double>(n_distance_bins);
  }
  for (const double d : distance) ++count[analysis::bin_of(d, 0.0, farthest, n_distance_bins)];
  table.add("distance", "m", middle);
  table.add("stones", "1", count);
  for (std::size_t c = 4; c < 8; ++c) {  // longitudinal, lateral, vertical, magnitude
    std::vector<double> mean(n_distance_bins, 0.0);
    for (std::size_t i = 0; i < distance.size(); ++i) {
      const std::size_t b = analysis::bin_of(distance[i], 0.0, farthest, n_distance_bins);
      mean[b] += std::abs(field.columns[c].values[i]) / count[b];
    }
    for (std::size_t b = 0; b < n_distance_bins; ++b) {
      if (count[b] == 0) mean[b] = std::nan("");
    }
    table.add(field.columns[c].name, "m", mean);
  }
  return table;
}

double largest_magnitude(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

Table pressure_table(const PressureHistory& history, std::size_t row) {
  const std::size_t n = history.n_x * history.n_y;
  std::vector<double> x(n), y(n), now(n), largest(n, 0.0), mean(n, 0.0);
  const std::size_t n_rows = history.time.size();
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = history.cell_length * (static_cast<double>(i / history.n_y) + 0.5);
    y[i] = history.cell_width * (static_cast<double>(i % history.n_y) + 0.5);
    now[i] = history.pressure[row * n + i];
    for (std::size_t r = 0; r < n_rows; ++r) {
      largest[i] = std::max(largest[i], history.pressure[r * n + i]);
      mean[i] += history.pressure[r * n + i] / static_cast<double>(n_rows);
    }
  }
  Table table{"pressure_" + history.name, {}};
  table.add("along", "m", x), table.add("across", "m", y);
  table.add("at_peak_load", "Pa", now), table.add("largest", "Pa", largest), table.add("mean", "Pa", mean);
  return table;
}

void add_stress(const Run& run, double mean_pressure, Findings& findings) {
  const auto& qdem = run.files.qdem();
  if (!qdem || qdem->n_steps() == 0) {
    findings.notes.push_back("stress in the stones: it needs output of the fields (qdem.h5)");
    return;
  }
  const auto times = qdem->read_rows("/VTKHDF/Steps/Values", qdem->n_steps()).values;
  const std::size_t step = nearest_row(times, run.load->time[run.load->peak]);
  const StoneMesh mesh(*qdem);
  const double stress = mesh.largest_stress(*qdem, step);
  const std::string group = "stress in the stones";
  findings.figures.push_back({group, "at the output of", times[step], "s"});
  findings.figures.push_back({group, "largest von Mises stress of an element", stress, "Pa"});
  findings.figures.push_back({group, "over the mean pressure under the sleeper", stress / mean_pressure, "1"});
  findings.figures.push_back({group, "mean size of an element", mesh.element_size(), "m"});
}

}  // namespace

void add_displacement_field(const Run& run, const Options&, Findings& findings) {
  const auto snapshot = snapshot_at_peak(run, findings);
  if (!snapshot || snapshot->place.empty() || !run.footprint) return;
  std::vector<double> distance;
  for (const auto& place : snapshot->place) distance.push_back(run.footprint->distance(place));
  auto field = field_table(*snapshot, distance);
  auto decay = decay_table(field);
  const std::string group = fmt::format("displacement of all stones at {:.4g} s", snapshot->time);
  for (std::size_t c = 4; c < 8; ++c) {
    findings.figures.push_back(
        {group, "largest, " + field.columns[c].name, largest_magnitude(field.columns[c].values), "m"});
  }
  findings.figures.push_back({group, "distance from the sleeper over which it falls to 1/e",
                              analysis::decay_length(decay.columns[0].values, decay.columns.back().values), "m"});
  findings.tables.push_back(std::move(field));
  findings.tables.push_back(std::move(decay));
}

void add_pressure(const Run& run, const Options&, Findings& findings) {
  const auto pressures = run.files.pressures();
  if (pressures.empty() || !run.load) {
    findings.notes.push_back("pressure under the sleeper: it needs a sensor of kind \"pressure\" in the case");
    return;
  }
  for (const auto& history : pressures) {
    const std::size_t row = nearest_row(history.time, run.load->time[run.load->peak]);
    auto table = pressure_table(history, row);
    const auto s = analysis::statistics(table.columns[2].values);
    const std::string group =
        fmt::format("pressure under the sleeper, {} ({} x {} cells)", history.name, history.n_x, history.n_y);
    findings.figures.push_back({group, "at", history.time[row], "s"});
    findings.figures.push_back({group, "mean", s.mean, "Pa"});
    findings.figures.push_back({group, "largest", s.largest, "Pa"});
    findings.figures.push_back({group, "largest over mean", s.largest / s.mean, "1"});
    findings.tables.push_back(std::move(table));
    if (&history == &pressures.front()) add_stress(run, s.mean, findings);
  }
}

}  // namespace coupler::study
