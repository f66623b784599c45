// Force chains, and where the energy went.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "coupler/study/analyses.hpp"

namespace coupler::study {
namespace {

constexpr double largest_force = 6.0;  // of the distribution, over the mean
constexpr std::size_t n_force_bins = 24;
constexpr const char* energy_group = "energies, from begin to end";

/// Row of the output nearest to `wanted`.
std::size_t nearest_output(const std::vector<double>& time, double wanted) {
  const auto nearer = [&](double p, double q) { return std::abs(p - wanted) < std::abs(q - wanted); };
  return static_cast<std::size_t>(std::min_element(time.begin(), time.end(), nearer) - time.begin());
}

Table chain_table(const ContactHistory& history, const std::set<int>& stones) {
  Table table{"contacts", {}};
  table.add("time", "s", history.time);
  std::vector<double> pairs, mean, largest, touched, strong, participation;
  for (const auto& contacts : history.contacts) {
    const auto figures = analysis::chain_figures(contacts);
    pairs.push_back(static_cast<double>(figures.n_pairs));
    mean.push_back(figures.mean_force), largest.push_back(figures.largest_force);
    touched.push_back(analysis::coordination(contacts, stones));
    strong.push_back(figures.strong_force_share), participation.push_back(figures.participation);
  }
  table.add("pairs", "1", pairs);
  table.add("mean_force", "N", mean);
  table.add("largest_force", "N", largest);
  table.add("coordination", "1", touched);
  table.add("force_share_above_mean", "1", strong);
  table.add("participation", "1", participation);
  return table;
}

Table distribution_table(const ContactHistory& history, std::size_t start, std::size_t peak, std::size_t unloaded) {
  Table table{"contact_forces", {}};
  std::vector<double> middle(n_force_bins);
  for (std::size_t b = 0; b < n_force_bins; ++b) {
    middle[b] = largest_force * (static_cast<double>(b) + 0.5) / static_cast<double>(n_force_bins);
  }
  table.add("force_over_mean", "1", middle);
  const auto density = [&](std::size_t row) {
    return analysis::force_distribution(history.contacts[row], largest_force, n_force_bins);
  };
  table.add("density_at_start", "1", density(start));
  table.add("density_at_peak_load", "1", density(peak));
  table.add("density_unloaded", "1", density(unloaded));
  return table;
}

/// Shares of the columns whose name ends in "_dissipation" in what they took together.
void add_sinks(const Table& energies, Findings& findings) {
  const std::string ending = "_dissipation";
  std::vector<std::pair<std::string, double>> sinks;
  double sum = 0.0;
  for (const auto& [name, unit, values] : energies.columns) {
    if (name.size() <= ending.size() || name.substr(name.size() - ending.size()) != ending) continue;
    sinks.emplace_back(name.substr(0, name.size() - ending.size()), values.back() - values.front());
    sum += sinks.back().second;
  }
  for (const auto& [name, taken] : sinks)
    findings.figures.push_back({"share of the dissipation", name, taken / sum, "1"});
}

Table energy_table(const proto::ResultReader& qdem) {
  const auto n = qdem.n_committed("/TimeSeries");
  Table table{"energies", {}};
  table.add("time", "s", qdem.read_rows("/TimeSeries/time", n).values);
  for (const auto& name : qdem.members("/TimeSeries")) {
    if (n == 0 || qdem.text("/TimeSeries/" + name, "units") != "J") continue;
    table.add(name, "J", qdem.read_rows("/TimeSeries/" + name, n).values);
  }
  return table;
}

void add_work_at_seats(const proto::ResultReader& coupling, Findings& findings) {
  for (const auto& seat : coupling.members("/seats")) {
    double given = 0.0;
    for (const double work : coupling.read_rows("/seats/" + seat + "/work_rail", coupling.n_committed()).values) {
      given -= work;
    }
    findings.figures.push_back({energy_group, "given by the rail at " + seat, given, "J"});
  }
}

}  // namespace

void add_force_chains(const Run& run, const Options&, Findings& findings) {
  const auto history = run.files.contacts();
  if (!history) {
    findings.notes.push_back("force chains: they need [qdem] contact_output = true and output of the fields");
    return;
  }
  const auto stones = run.files.stone_numbers();
  auto table = chain_table(*history, stones);
  const std::size_t last = history->time.size() - 1;
  const std::size_t peak = run.load ? nearest_output(history->time, run.load->time[run.load->peak]) : last;
  const std::size_t unloaded = run.load ? nearest_output(history->time, run.load->time[run.load->unloaded]) : last;
  const std::string group = fmt::format("contacts at {:.4g} s", history->time[peak]);
  for (std::size_t c = 1; c < table.columns.size(); ++c) {
    const auto& column = table.columns[c];
    findings.figures.push_back({group, column.name, column.values[peak], column.unit});
  }
  findings.figures.push_back({group,
                              fmt::format("share of the pairs that are lost by {:.4g} s", history->time[unloaded]),
                              analysis::lost_share(history->contacts[peak], history->contacts[unloaded]), "1"});
  findings.tables.push_back(std::move(table));
  findings.tables.push_back(distribution_table(*history, 0, peak, unloaded));
}

void add_energies(const Run& run, const Options&, Findings& findings) {
  if (run.files.coupling()) add_work_at_seats(*run.files.coupling(), findings);
  const auto& qdem = run.files.qdem();
  if (!qdem || !qdem->has("/TimeSeries")) {
    findings.notes.push_back("energies: they need output of the fields (qdem.h5)");
    return;
  }
  auto table = energy_table(*qdem);
  for (std::size_t c = 1; c < table.columns.size(); ++c) {
    const auto& [name, unit, values] = table.columns[c];
    findings.figures.push_back({energy_group, name, values.back() - values.front(), unit});
  }
  add_sinks(table, findings);
  findings.tables.push_back(std::move(table));
}

}  // namespace coupler::study
