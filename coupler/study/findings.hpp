// What an analysis found: tables, figures, and what it could not do.
#pragma once

#include <string>
#include <vector>

#include "proto/result/attributes.hpp"

namespace coupler::study {

/// Columns of equal length; written as NAME.csv and as the group NAME of analysis.h5.
struct Table {
  struct Column {
    std::string name;
    std::string unit;  ///< "1" for a pure number
    std::vector<double> values;
  };
  std::string name;
  std::vector<Column> columns;

  void add(std::string column, std::string unit, std::vector<double> values) {
    columns.push_back({std::move(column), std::move(unit), std::move(values)});
  }
  std::size_t n_rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
};

/// One number for the summary.
struct Figure {
  std::string group;  ///< heading under which it is printed
  std::string name;
  double value = 0.0;  ///< NaN: not defined
  std::string unit;
};

struct Findings {
  std::vector<Table> tables;
  std::vector<Figure> figures;
  std::vector<std::string> notes;  ///< one line each: what is missing or too short, and what to do
};

/// "name [unit],..." and one line a row.
std::string csv_text(const Table& table);
/// "group,figure,value,unit" and one line a figure.
std::string figures_csv(const Findings& findings);
/// What a person reads on the terminal.
std::string summary_text(const Findings& findings, const std::string& source, const std::string& out);

/// Writes analysis.h5, figures.csv and a CSV file for every table into `folder`, which is created if need be.
/// Throws proto::Error (cannot_create, io_error).
void write_findings(const Findings& findings, const std::string& folder, proto::Attributes attributes);

}  // namespace coupler::study
