#include "coupler/page/run_facts.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>
#include <variant>

#include "coupler/study/run_files.hpp"
#include "proto/case/case_file.hpp"
#include "proto/case/coupling.hpp"
#include "proto/error.hpp"
#include "proto/result/provenance.hpp"

namespace coupler::page {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t most_warnings = 20;  // of a log

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// The number under a JSON pointer, if there is one.
std::optional<double> number(const json& data, const std::string& pointer) {
  const json::json_pointer place(pointer);
  if (!data.contains(place) || !data.at(place).is_number()) return std::nullopt;
  return data.at(place).get<double>();
}

/// Sentences from what the run reported.
void add_summary_words(const json& summary, std::vector<std::string>& words) {
  const auto stones = number(summary, "/bed/stones"), elements = number(summary, "/bed/elements"),
             porosity = number(summary, "/bed/porosity");
  if (stones && elements) {
    std::string text =
        fmt::format("The bed holds {:.0f} stones of {:.0f} tetrahedra in all, with the sleeper's", *stones, *elements);
    if (porosity) text += fmt::format("; the porosity of its layer is {:.3f}", *porosity);
    words.push_back(text + ".");
  }
  const auto unknowns = number(summary, "/fem/unknowns"), length = number(summary, "/fem/rail_length_m");
  if (unknowns && length) {
    words.push_back(fmt::format("The rail is {:.3g} m long and has {:.0f} unknowns.", *length, *unknowns));
  }
  const auto windows = number(summary, "/windows"), window = number(summary, "/window_s"),
             steps = number(summary, "/sub_cycles"), total = number(summary, "/wall_s/total");
  if (windows && window) {
    std::string text =
        fmt::format("{:.0f} windows of {:.4g} µs make {:.4g} ms", *windows, *window * 1e6, *windows * *window * 1e3);
    if (steps) text += fmt::format("; the stones took {:.0f} steps in each", *steps);
    if (total) text += fmt::format(", and everything took {:.3g} s of wall time", *total);
    words.push_back(text + ".");
  }
}

/// Sentences from the case, the wheel's radius, the limits of the audit; a case that another version of the program
/// made may not be readable.
void add_case_words(const std::string& path, json& facts, std::vector<std::string>& words) {
  try {
    const auto file = proto::CaseFile::load(path);
    const auto wheel = file.section("wheel");
    if (wheel.has("static_load_n") && wheel.has("speed_m_per_s")) {
      words.push_back(fmt::format("A wheel of {:.4g} kN rolls along the rail at {:.4g} m/s ({:.4g} km/h).",
                                  wheel.number("static_load_n") * 1e-3, wheel.number("speed_m_per_s"),
                                  wheel.number("speed_m_per_s") * 3.6));
    }
    if (wheel.has("radius_m")) facts["wheel_radius"] = wheel.number("radius_m");
    const auto audit = file.section("coupling").section("audit");
    const proto::AuditLimits standard;
    facts["audit_limits"] = {{"energy", audit.number_or("energy", standard.energy)},
                             {"momentum", audit.number_or("momentum", standard.momentum)},
                             {"moment", audit.number_or("moment", standard.moment)}};
  } catch (const proto::Error& error) {
    facts["warnings"].push_back(std::string("the case could not be read: ") + error.what());
  }
}

json provenance_json(const std::string& folder) {
  json pairs = json::array();
  for (const auto& [key, value] : study::RunFiles(folder).provenance()) {
    if (key == "case_text") continue;
    pairs.push_back({key, std::visit(
                              [](const auto& held) {
                                if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::string>)
                                  return held;
                                else
                                  return fmt::format("{}", held);
                              },
                              value)});
  }
  return pairs;
}

}  // namespace

std::string leading_comment(const std::string& case_text) {
  std::istringstream lines(case_text);
  std::string paragraph;
  for (std::string line; std::getline(lines, line) && !line.empty() && line[0] == '#';) {
    const auto begin = line.find_first_not_of("# \t");
    if (line.rfind("#:", 0) == 0 || begin == std::string::npos) continue;
    paragraph += (paragraph.empty() ? "" : " ") + line.substr(begin);
  }
  return paragraph;
}

std::vector<std::string> warnings_of(const std::string& log, std::size_t n_most) {
  std::istringstream lines(log);
  std::vector<std::string> result;
  std::size_t n_more = 0;
  for (std::string line; std::getline(lines, line);) {
    bool warns = false;
    for (const char* word : {"warn", "error", "critical"}) warns = warns || line.find(word) != std::string::npos;
    if (!warns) continue;
    if (result.size() < n_most)
      result.push_back(line);
    else
      ++n_more;
  }
  if (n_more > 0) result.push_back(fmt::format("... and {} more lines", n_more));
  return result;
}

json run_facts(const std::string& folder) {
  json facts = {{"warnings", json::array()}, {"summary", json::object()}};
  const fs::path path = fs::absolute(folder).lexically_normal();
  facts["folder"] = (path.has_filename() ? path : path.parent_path()).filename().string();
  facts["name"] = facts["folder"];
  std::vector<std::string> words;
  const std::string case_path = folder + "/case.toml";
  if (fs::exists(case_path)) {
    const std::string text = read_text(case_path);
    facts["case_text"] = text, facts["question"] = leading_comment(text);
    add_case_words(case_path, facts, words);
  }
  if (fs::exists(folder + "/summary.json")) {
    auto summary = json::parse(read_text(folder + "/summary.json"), nullptr, false);
    if (summary.is_object()) {
      add_summary_words(summary, words);
      if (summary.contains("/case/name"_json_pointer)) facts["name"] = summary["case"]["name"];
      if (summary.contains("status")) facts["status"] = summary["status"];
      if (summary.contains("/failure/message"_json_pointer)) {
        facts["warnings"].push_back(summary["failure"]["message"]);
      }
      facts["summary"] = std::move(summary);
    } else {
      facts["warnings"].push_back("summary.json is not whole");
    }
  }
  facts["words"] = words;
  for (const char* log : {"run.log", "qdem.log", "fem.log"}) {
    for (const auto& line : warnings_of(read_text(folder + "/" + log), most_warnings)) {
      facts["warnings"].push_back(std::string(log) + ": " + line);
    }
  }
  facts["provenance"] = provenance_json(folder);
  return facts;
}

}  // namespace coupler::page
