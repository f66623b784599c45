// T(f,z) and the fall of motion with depth.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "coupler/analysis/statistics.hpp"
#include "coupler/analysis/transfer.hpp"
#include "coupler/study/analyses.hpp"
#include "coupler/study/records.hpp"

namespace coupler::study {
namespace {

constexpr double record_for_low_frequencies = 0.2;  // [s]

/// What T(f,z) and the attenuation need; else a note.
bool has_layer(const Run& run, const std::string& what, Findings& findings) {
  std::string missing;
  if (!run.stones) missing += "\"stones\"";
  if (!run.bottom) missing += std::string(missing.empty() ? "" : " and ") + "\"bottom\"";
  if (!missing.empty()) {
    findings.notes.push_back(what + ": it needs a sensor of kind " + missing +
                             " in the case, see qdem_solver/README.md");
    return false;
  }
  return true;
}

std::vector<analysis::DepthBin> bins_of(const Run& run, const Options& options, const std::string& what,
                                        Findings& findings) {
  auto bins = analysis::depth_bins(run.stones->place, *run.footprint, options.n_bins, options.reach);
  if (bins.empty()) findings.notes.push_back(what + ": no stone lies under the sleeper - give a --reach");
  return bins;
}

/// Cell of the bottom whose centre is nearest to a stone, seen from above.
std::size_t cell_above(const analysis::Motion& bottom, const std::array<double, 3>& place) {
  std::size_t nearest = 0;
  const auto distance = [&](std::size_t i) {
    return std::hypot(bottom.place[i][0] - place[0], bottom.place[i][1] - place[1]);
  };
  for (std::size_t i = 1; i < bottom.n_points(); ++i) {
    if (distance(i) < distance(nearest)) nearest = i;
  }
  return nearest;
}

analysis::BottomReference reference_of(const analysis::Motion& bottom, int axis, const analysis::Segmentation& cut) {
  std::vector<analysis::SegmentTransforms> cells;
  for (std::size_t cell = 0; cell < bottom.n_points(); ++cell) {
    cells.push_back(analysis::segment_transforms(bottom.history(bottom.velocity, cell, axis), bottom.interval, cut));
  }
  return analysis::BottomReference(std::move(cells));
}

/// Mean and spread over the responses, line by line.
struct BinResponse {
  std::vector<double> mean, deviation, coherence;
};

BinResponse response_of(const analysis::DepthBin& bin, const Run& run, int axis, const analysis::Segmentation& cut,
                        const analysis::BottomReference& reference) {
  const auto& stones = *run.stones;
  std::vector<analysis::Response> responses;
  for (const std::size_t stone : bin.points) {
    const auto spectra =
        analysis::segment_transforms(stones.history(stones.velocity, stone, axis), stones.interval, cut);
    responses.push_back(reference.response(spectra, cell_above(*run.bottom, stones.place[stone])));
  }
  BinResponse result;
  for (std::size_t k = 0; k < reference.frequency().size(); ++k) {
    std::vector<double> magnitude, coherence;
    for (const auto& response : responses) {
      magnitude.push_back(response.magnitude[k]), coherence.push_back(response.coherence[k]);
    }
    const auto s = analysis::statistics(magnitude);
    result.mean.push_back(s.mean), result.deviation.push_back(s.deviation);
    result.coherence.push_back(analysis::statistics(coherence).mean);
  }
  return result;
}

/// One row a depth bin.
class BandTable {
 public:
  explicit BandTable(std::string name) { table_.name = std::move(name); }
  void put(const std::string& column, const std::string& unit, double value) {
    for (auto& known : table_.columns) {
      if (known.name == column) return known.values.push_back(value);
    }
    table_.add(column, unit, {value});
  }
  void put_bin(const analysis::DepthBin& bin) {
    put("top", "m", bin.top), put("bottom", "m", bin.bottom);
    put("stones", "1", static_cast<double>(bin.points.size()));
  }
  Table take() { return std::move(table_); }

 private:
  Table table_;
};

std::string name_of(const std::vector<analysis::DepthBin>& bins, std::size_t b) {
  return fmt::format("bin {}, depth {:.0f} to {:.0f} mm, {} stones", b + 1, 1e3 * bins[b].top, 1e3 * bins[b].bottom,
                     bins[b].points.size());
}

/// Band means of a bin, as columns NAME, NAME_deviation, NAME_coherence and as figures; returns the first. The line at
/// 0 never counts.
double put_band(BandTable& table, const std::string& name, const BinResponse& response,
                const std::vector<double>& frequency, const Band& band, const Figure& label, Findings& findings) {
  const auto mean = [&](const std::vector<double>& values) {
    return analysis::band_mean(frequency, values, std::max(band.low, 0.5 * frequency[1]), band.high);
  };
  const double magnitude = mean(response.mean), coherence = mean(response.coherence);
  table.put(name, "1", magnitude);
  table.put(name + "_deviation", "1", mean(response.deviation));
  table.put(name + "_coherence", "1", coherence);
  const std::string text = fmt::format("{}, {}: {:g} to {:g} Hz", label.name, name, band.low, band.high);
  findings.figures.push_back({label.group, text, magnitude, "1"});
  findings.figures.push_back({label.group, text + ", coherence", coherence, "1"});
  return magnitude;
}

void note_short_record(double record, double resolution, Findings& findings) {
  if (record >= record_for_low_frequencies) return;
  findings.notes.push_back(fmt::format(
      "T(f,z): below 100 Hz it needs sensors \"stones\" and \"bottom\" over {} s or more; the record is {:.4g} s: "
      "resolution {:.4g} Hz",
      record_for_low_frequencies, record, resolution));
}

}  // namespace

void add_transfer(const Run& run, const Options& options, Findings& findings) {
  if (!has_layer(run, "T(f,z)", findings)) return;
  const auto bins = bins_of(run, options, "T(f,z)", findings);
  const auto& stones = *run.stones;
  std::string why;
  const auto cut = segmentation(stones.n_samples(), stones.interval, options, why);
  if (!cut) findings.notes.push_back("T(f,z): " + why);
  if (bins.empty() || !cut) return;
  const auto reference = reference_of(*run.bottom, options.axis, *cut);
  const auto& frequency = reference.frequency();
  note_short_record(stones.interval * static_cast<double>(stones.n_samples()), frequency[1], findings);
  const std::array directions{"longitudinal", "lateral", "vertical"};
  const std::string group = fmt::format("T(f,z), {} motion", directions[static_cast<std::size_t>(options.axis)]);
  add_resolution(group, "T(f,z)", *cut, stones.n_samples(), stones.interval, findings);

  Table lines{"transfer", {}};
  lines.add("frequency", "Hz", frequency);
  lines.add("bottom_density", "(m/s)^2/Hz", reference.power());
  BandTable bands("transfer_bands");
  double n_low_below_high = 0;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const auto response = response_of(bins[b], run, options.axis, *cut, reference);
    lines.add(fmt::format("bin_{}", b + 1), "1", response.mean);
    lines.add(fmt::format("bin_{}_deviation", b + 1), "1", response.deviation);
    lines.add(fmt::format("bin_{}_coherence", b + 1), "1", response.coherence);
    bands.put_bin(bins[b]);
    const Figure label{group, name_of(bins, b), 0.0, "1"};
    const double low = put_band(bands, "low", response, frequency, options.low, label, findings);
    const double high = put_band(bands, "high", response, frequency, options.high, label, findings);
    n_low_below_high += low < high ? 1 : 0;
  }
  findings.figures.push_back({group, "depth bins in which low frequencies are absorbed more", n_low_below_high, "1"});
  findings.tables.push_back(std::move(lines));
  findings.tables.push_back(bands.take());
}

void add_attenuation(const Run& run, const Options& options, Findings& findings) {
  if (!has_layer(run, "attenuation with depth", findings)) return;
  const auto bins = bins_of(run, options, "attenuation with depth", findings);
  if (bins.empty()) return;
  const auto& stones = *run.stones;
  const auto& bottom = *run.bottom;
  double power = 0.0;
  for (std::size_t cell = 0; cell < bottom.n_points(); ++cell) {
    const double rms = analysis::rms(bottom.history(bottom.velocity, cell, 2));
    power += rms * rms / static_cast<double>(bottom.n_points());
  }
  BandTable table("attenuation");
  std::vector<double> depth, speed;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const auto& bin = bins[b];
    table.put_bin(bin);
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> rms, peak;
      for (const std::size_t stone : bin.points) {
        rms.push_back(analysis::rms(stones.history(stones.velocity, stone, axis)));
        peak.push_back(analysis::peak_change(stones.history(stones.displacement, stone, axis)));
      }
      const auto velocity = analysis::statistics(rms), displacement = analysis::statistics(peak);
      const char letter = "xyz"[axis];
      table.put(fmt::format("rms_velocity_{}", letter), "m/s", velocity.mean);
      table.put(fmt::format("rms_velocity_{}_deviation", letter), "m/s", velocity.deviation);
      table.put(fmt::format("peak_displacement_{}", letter), "m", displacement.mean);
      table.put(fmt::format("peak_displacement_{}_deviation", letter), "m", displacement.deviation);
      if (axis != 2) continue;
      table.put("vertical_over_bottom", "1", velocity.mean / std::sqrt(power));
      findings.figures.push_back({"attenuation, rms of vertical velocity over the bottom's", name_of(bins, b),
                                  velocity.mean / std::sqrt(power), "1"});
      if (velocity.n > 0) depth.push_back(bin.middle()), speed.push_back(velocity.mean);
    }
  }
  findings.figures.push_back({"attenuation, rms of vertical velocity over the bottom's",
                              "depth over which it falls to 1/e", analysis::decay_length(depth, speed), "m"});
  findings.tables.push_back(table.take());
}

}  // namespace coupler::study
