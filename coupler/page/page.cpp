#include "coupler/page/page.hpp"

#include "coupler/page/encode.hpp"
#include "coupler/page/run_facts.hpp"
#include "coupler/page/run_tables.hpp"
#include "coupler/page/scene.hpp"
#include "coupler/study/analyses.hpp"
#include "proto/error.hpp"
#include "proto/result/provenance.hpp"

namespace coupler::page {
namespace {

using nlohmann::json;

const std::string data_mark = "__RUN_DATA__";  // where the page wants its data
constexpr int format = 1;                      // of the data; the page refuses another one

struct RunContent {
  json facts;
  std::vector<study::Table> tables;
};

RunContent read_run(const std::string& folder) {
  auto findings = study::analyse(folder, {});
  RunContent run{run_facts(folder), record_tables(folder)};
  for (auto& table : findings.tables) run.tables.push_back(std::move(table));
  auto figures = json::array();
  for (const auto& figure : findings.figures) {
    figures.push_back({{"group", figure.group}, {"name", figure.name}, {"value", figure.value}, {"unit", figure.unit}});
  }
  run.facts["figures"] = std::move(figures), run.facts["notes"] = findings.notes;
  return run;
}

/// The runs with tables of at most `n_rows` rows.
json runs_json(const std::vector<RunContent>& runs, std::size_t n_rows) {
  auto result = json::array();
  for (const auto& run : runs) {
    auto tables = json::array();
    for (const auto& table : run.tables) tables.push_back(table_json(table, n_rows));
    result.push_back(run.facts);
    result.back()["tables"] = std::move(tables);
  }
  return result;
}

}  // namespace

json page_data(const std::vector<std::string>& folders, std::size_t n_characters) {
  std::vector<RunContent> runs;
  for (const auto& folder : folders) runs.push_back(read_run(folder));
  json data = {{"format", format},
               {"program", "coupler " + proto::project_version() + " (" + proto::source_description() + ")"},
               {"size_limit", n_characters}};
  std::size_t length = 0;
  for (std::size_t n_rows = 16384; n_rows >= 64; n_rows /= 2) {  // tables take half of the page at most
    data["runs"] = runs_json(runs, n_rows);
    length = script_text(data).size();
    if (2 * length <= n_characters) break;
  }
  data["scene"] = scene_json(folders.front(), n_characters > length ? n_characters - length : 0);
  return data;
}

std::string filled_page(const std::string& page, const json& data) {
  const auto place = page.find(data_mark);
  if (place == std::string::npos || page.find(data_mark, place + 1) != std::string::npos) {
    throw proto::Error(proto::ExitCode::bad_data, "this is not the page of coupler/report_page", "report_page.html",
                       "build the target report_page again");
  }
  return page.substr(0, place) + script_text(data) + page.substr(place + data_mark.size());
}

}  // namespace coupler::page
