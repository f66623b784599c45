// The report: one HTML file that holds the runs it shows.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace coupler::page {

/// {"format", "program", "size_limit", "runs": [facts, figures, notes, tables], "scene"}: everything that the page
/// shows of the runs in `folders`, the 3-D view of the first one, in at most `n_characters`. Throws proto::Error as
/// study::analyse() does.
nlohmann::json page_data(const std::vector<std::string>& folders, std::size_t n_characters);

/// The page made by coupler/report_page with `data` in it. Throws proto::Error (bad_data) when `page` is no such page.
std::string filled_page(const std::string& page, const nlohmann::json& data);

}  // namespace coupler::page
