// What is drawn as charts: the analysis of a run and the records that it does not cover.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "coupler/study/findings.hpp"

namespace coupler::page {

/// Tables of the run in `folder` beyond those of study::analyse(): `wheel` (fem.h5), `interface_audit` and
/// `computing_time` (coupling.h5). Where a record is missing, so is its table.
std::vector<study::Table> record_tables(const std::string& folder);

/// {"name", "rows", "block", "columns": [{"name", "unit", "f32"}]}. A table of more than `n_rows` rows is cut into
/// blocks of `block` rows: of each the first value of the first column and the value of largest magnitude of the
/// others.
nlohmann::json table_json(const study::Table& table, std::size_t n_rows);

}  // namespace coupler::page
