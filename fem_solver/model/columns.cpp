#include "fem_solver/model/columns.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "proto/error.hpp"

namespace fem {

TwoColumns::TwoColumns(const std::string& path, const std::string& what, const std::string& columns)
    : path_(path), what_(what), columns_(columns) {
  std::ifstream file(path);
  if (!file) throw proto::Error(proto::ExitCode::missing_input, "cannot read the " + what, path);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    line = line.substr(0, line.find('#'));
    std::replace(line.begin(), line.end(), ',', ' ');
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream words(line);
    Row row{0.0, 0.0, number};
    std::string rest;
    const bool read = static_cast<bool>(words >> row.first >> row.second) && !(words >> rest);
    if (!read || !std::isfinite(row.first) || !std::isfinite(row.second))
      throw proto::Error(proto::ExitCode::bad_data, "a line of the " + what + " is not two numbers '" + columns + "'",
                         path + ":" + std::to_string(number));
    rows_.push_back(row);
  }
}

void TwoColumns::require_ascending() const {
  for (std::size_t i = 1; i < rows_.size(); ++i)
    if (rows_[i].first <= rows_[i - 1].first)
      throw proto::Error(proto::ExitCode::bad_data,
                         "the first column of the " + what_ + " ('" + columns_ + "') does not ascend",
                         path_ + ":" + std::to_string(rows_[i].line));
  if (rows_.size() < 2)
    throw proto::Error(proto::ExitCode::bad_data, "the " + what_ + " needs at least two lines", path_);
}

}  // namespace fem
