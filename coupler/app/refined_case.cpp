#include "coupler/app/refined_case.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "proto/error.hpp"

namespace coupler {

std::string with_finer_cells(const proto::CaseFile& original, int factor) {
  static const std::regex header(R"(^\s*\[+\s*([^\]\s]+)\s*\]+.*$)"), case_folder(R"((^|\n)\s*case_folder\s*=)"),
      cells(R"(^(\s*cells\s*=\s*\[\s*)(\d+)(\s*,\s*)(\d+)(\s*\].*)$)");
  std::istringstream lines(original.text());
  std::string line, table, result;
  // The refined case lies elsewhere, what its relative paths name does not.
  if (!std::regex_search(original.text(), case_folder))
    result = fmt::format("case_folder = {}\n",
                         nlohmann::json(std::filesystem::path(original.path()).parent_path().string()).dump());
  int n_seats = 0, n_refined = 0;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (std::regex_match(line, match, header)) {
      table = match[1];
      n_seats += table == "rail_seat";
    } else if (table == "rail_seat" && std::regex_match(line, match, cells)) {
      line = fmt::format("{}{}{}{}{}", match[1].str(), std::stoi(match[2]) * factor, match[3].str(),
                         std::stoi(match[4]) * factor, match[5].str());
      ++n_refined;
    }
    result += line + "\n";
  }
  if (n_refined != n_seats)
    throw proto::Error(proto::ExitCode::config, "the cells of a [[rail_seat]] are not on a line of their own",
                       "rail_seat", "write cells = [n, m] on one line to have them refined");
  return result;
}

}  // namespace coupler
