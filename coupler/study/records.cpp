#include "coupler/study/records.hpp"

#include <fmt/format.h>

#include <cmath>

namespace coupler::study {
namespace {

constexpr std::size_t fewest_samples = 8;  // of a segment

/// Largest length up to n without prime factors above 5: longer ones transform quickly, and little is cut off.
std::size_t quick_length(std::size_t n) {
  for (;; --n) {
    std::size_t rest = n;
    for (const std::size_t p : {2u, 3u, 5u}) {
      while (rest % p == 0) rest /= p;
    }
    if (rest == 1) return n;
  }
}

void add_amplitudes(const std::string& name, double interval, const std::vector<Table::Column>& columns,
                    Findings& findings) {
  const std::size_t n = quick_length(columns.front().values.size());
  Table table{"amplitude_" + name, {}};
  table.add("frequency", "Hz", analysis::frequencies(n, interval));
  for (const auto& column : columns) {
    table.add(column.name, column.unit, analysis::amplitude_spectrum({column.values.data(), n}));
  }
  findings.tables.push_back(std::move(table));
}

void add_densities(const std::string& name, double interval, const std::vector<Table::Column>& columns,
                   const Options& options, Findings& findings) {
  std::string why;
  const std::size_t n = columns.front().values.size();
  const auto cut = segmentation(n, interval, options, why);
  if (!cut) {
    findings.notes.push_back("density of " + name + ": " + why);
    return;
  }
  Table table{"density_" + name, {}};
  for (const auto& column : columns) {
    const auto spectra = analysis::segment_transforms(column.values, interval, *cut);
    if (table.columns.empty()) table.add("frequency", "Hz", spectra.frequency);
    table.add(column.name, "(" + column.unit + ")^2/Hz", analysis::power_density(spectra));
  }
  findings.tables.push_back(std::move(table));
  add_resolution("spectral densities", name, *cut, n, interval, findings);
}

}  // namespace

std::optional<analysis::Segmentation> segmentation(std::size_t n_samples, double interval, const Options& options,
                                                   std::string& why) {
  if (n_samples < 2 * fewest_samples) {
    why = fmt::format("{} samples are too few", n_samples);
    return std::nullopt;
  }
  analysis::Segmentation cut;
  cut.window = options.window;
  cut.length = options.segment > 0 ? static_cast<std::size_t>(std::llround(options.segment / interval)) : n_samples / 2;
  cut.overlap = static_cast<std::size_t>(options.overlap * static_cast<double>(cut.length));
  const double record = interval * static_cast<double>(n_samples);
  if (cut.length > n_samples) {
    why = fmt::format("a segment of {:.4g} s is longer than the record of {:.4g} s - give a shorter --segment",
                      options.segment, record);
    return std::nullopt;
  }
  if (cut.length < fewest_samples) {
    why = fmt::format("a segment would hold {} samples - give a longer --segment", cut.length);
    return std::nullopt;
  }
  return cut;
}

void add_resolution(const std::string& group, const std::string& name, const analysis::Segmentation& cut,
                    std::size_t n_samples, double interval, Findings& findings) {
  const double length = interval * static_cast<double>(cut.length);
  findings.figures.push_back({group, name + ": resolution", 1 / length, "Hz"});
  findings.figures.push_back(
      {group, name + ": averages", static_cast<double>(analysis::n_segments(n_samples, cut)), "1"});
}

void add_record(const std::string& name, const std::vector<double>& time, double interval,
                const std::vector<Table::Column>& columns, const Options& options, Findings& findings) {
  Table table{"history_" + name, {}};
  table.add("time", "s", time);
  for (const auto& column : columns) table.columns.push_back(column);
  findings.tables.push_back(std::move(table));
  if (time.size() < 2 * fewest_samples) {
    findings.notes.push_back(fmt::format("spectra of {}: {} samples are too few", name, time.size()));
    return;
  }
  add_amplitudes(name, interval, columns, findings);
  add_densities(name, interval, columns, options, findings);
}

std::vector<Table::Column> components(const std::string& what, const std::string& unit,
                                      const std::vector<double>& values) {
  std::vector<Table::Column> columns;
  for (int axis = 0; axis < 3; ++axis) {
    Table::Column column{what + "_" + "xyz" [axis], unit, {}};
    for (std::size_t i = static_cast<std::size_t>(axis); i < values.size(); i += 3) column.values.push_back(values[i]);
    columns.push_back(std::move(column));
  }
  return columns;
}

}  // namespace coupler::study
