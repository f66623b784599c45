#include "coupler/study/findings.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "proto/error.hpp"
#include "proto/result/array_file.hpp"
#include "proto/result/text_file.hpp"

namespace coupler::study {

std::string csv_text(const Table& table) {
  std::string text;
  for (const auto& column : table.columns) {
    text += fmt::format("{}{} [{}]", text.empty() ? "" : ",", column.name, column.unit);
  }
  text += '\n';
  for (std::size_t row = 0; row < table.n_rows(); ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      text += fmt::format("{}{:.9g}", c == 0 ? "" : ",", table.columns[c].values[row]);
    }
    text += '\n';
  }
  return text;
}

std::string figures_csv(const Findings& findings) {
  std::string text = "group,figure,value,unit\n";
  for (const auto& figure : findings.figures) {
    text += fmt::format("\"{}\",\"{}\",{:.9g},{}\n", figure.group, figure.name, figure.value, figure.unit);
  }
  return text;
}

std::string summary_text(const Findings& findings, const std::string& source, const std::string& out) {
  std::string text = fmt::format("\nanalysis of {}\n", source), group;
  for (const auto& figure : findings.figures) {
    if (figure.group != group) text += figure.group + "\n";
    group = figure.group;
    text += fmt::format("  {:<66}{:>12.5g} {}\n", figure.name, figure.value, figure.unit == "1" ? "" : figure.unit);
  }
  for (const auto& note : findings.notes) text += fmt::format("note: {}\n", note);
  text += fmt::format("{} tables (CSV) and analysis.h5 in {}\n", findings.tables.size(), out);
  return text;
}

void write_findings(const Findings& findings, const std::string& folder, proto::Attributes attributes) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    throw proto::Error(proto::ExitCode::cannot_create, "cannot create the folder (" + failure.message() + ")", folder);
  }
  std::vector<proto::NamedArray> arrays;
  for (const auto& table : findings.tables) {
    proto::write_text_file(folder + "/" + table.name + ".csv", csv_text(table));
    for (const auto& column : table.columns) {
      arrays.push_back({table.name + "/" + column.name, column.unit, {}, column.values});
    }
  }
  for (const auto& figure : findings.figures) {
    arrays.push_back({"figures/" + figure.group + "/" + figure.name, figure.unit, {}, {figure.value}});
  }
  std::string notes;
  for (const auto& note : findings.notes) notes += note + "\n";
  attributes.emplace_back("notes", notes);
  proto::write_array_file(folder + "/analysis.h5", arrays, attributes);
  proto::write_text_file(folder + "/figures.csv", figures_csv(findings));
}

}  // namespace coupler::study
