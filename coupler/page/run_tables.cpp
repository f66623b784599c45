#include "coupler/page/run_tables.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "coupler/page/encode.hpp"
#include "proto/result/reader.hpp"

namespace coupler::page {
namespace {

using proto::ResultReader;
using study::Table;

std::optional<ResultReader> open_history(const std::string& path, const std::string& group) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  ResultReader file(path);
  if (!file.has(group == "/" ? "/time" : group + "/time") || file.n_committed(group) == 0) return std::nullopt;
  return file;
}

void add_column(const ResultReader& file, const std::string& dataset, const std::string& name, std::uint64_t n,
                Table& table) {
  table.add(name, file.has_attribute(dataset, "units") ? file.text(dataset, "units") : "1",
            file.read_rows(dataset, n).values);
}

void add_wheels(const std::string& folder, std::vector<Table>& tables) {
  const auto file = open_history(folder + "/fem.h5", "/TimeSeries");
  if (!file) return;
  const auto n = file->n_committed("/TimeSeries");
  for (const auto& group : file->members("/TimeSeries")) {
    const std::string path = "/TimeSeries/" + group;
    if (!file->has(path + "/contact_force")) continue;
    Table table{group, {}};
    add_column(*file, "/TimeSeries/time", "time", n, table);
    for (const auto& name : file->members(path)) {
      if (file->shape(path + "/" + name).size() == 1) add_column(*file, path + "/" + name, name, n, table);
    }
    tables.push_back(std::move(table));
  }
}

/// Largest magnitude over the axes of the seat's resultant, in every row of [n][cells][3] values.
std::vector<double> resultant(const std::vector<double>& values, std::size_t n_rows) {
  const std::size_t width = values.size() / n_rows;
  std::vector<double> result;
  for (std::size_t row = 0; row < n_rows; ++row) {
    double sum[3] = {0, 0, 0};
    for (std::size_t i = 0; i < width; ++i) sum[i % 3] += values[row * width + i];
    result.push_back(std::max({std::abs(sum[0]), std::abs(sum[1]), std::abs(sum[2])}));
  }
  return result;
}

void add_audit(const std::string& folder, std::vector<Table>& tables) {
  const auto file = open_history(folder + "/coupling.h5", "/");
  if (!file) return;
  const auto n = file->n_committed();
  Table audit{"interface_audit", {}}, computing{"computing_time", {}};
  add_column(*file, "/time", "time", n, audit);
  add_column(*file, "/energy_defect_sum", "energy_defect_sum", n, audit);
  for (const auto& seat : file->members("/seats")) {
    const std::string dataset = "/seats/" + seat + "/momentum_defect_sum";
    audit.add("momentum_defect_" + seat, file->text(dataset, "units"),
              resultant(file->read_rows(dataset, n).values, n));
  }
  tables.push_back(std::move(audit));
  add_column(*file, "/time", "time", n, computing);
  for (const char* name : {"qdem_compute", "fem_compute"}) {
    add_column(*file, std::string("/") + name, name, n, computing);
  }
  tables.push_back(std::move(computing));
}

/// Of each block of `block` values the one of largest magnitude; where `first`, the first one.
std::vector<double> thinned(const std::vector<double>& values, std::size_t block, bool first) {
  std::vector<double> result;
  for (std::size_t begin = 0; begin < values.size(); begin += block) {
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), begin + block));
    const auto start = values.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
    result.push_back(first ? *start : *std::max_element(start, end, smaller));
  }
  return result;
}

}  // namespace

std::vector<Table> record_tables(const std::string& folder) {
  std::vector<Table> tables;
  add_wheels(folder, tables);
  add_audit(folder, tables);
  return tables;
}

nlohmann::json table_json(const Table& table, std::size_t n_rows) {
  const std::size_t block = std::max<std::size_t>(1, (table.n_rows() + n_rows - 1) / n_rows);
  auto columns = nlohmann::json::array();
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const auto& column = table.columns[c];
    columns.push_back({{"name", column.name},
                       {"unit", column.unit},
                       {"f32", float_json(block == 1 ? column.values : thinned(column.values, block, c == 0))}});
  }
  return {{"name", table.name}, {"rows", table.n_rows()}, {"block", block}, {"columns", columns}};
}

}  // namespace coupler::page
