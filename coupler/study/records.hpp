// From a record to its spectra.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coupler/analysis/spectrum.hpp"
#include "coupler/study/findings.hpp"
#include "coupler/study/options.hpp"

namespace coupler::study {

/// How a record of `n_samples` every `interval` [s] is cut by the options; nothing when it is shorter than a segment,
/// or a segment than 8 samples: then `why` says so.
std::optional<analysis::Segmentation> segmentation(std::size_t n_samples, double interval, const Options& options,
                                                   std::string& why);

/// Adds the figures "NAME: resolution" and "NAME: averages".
void add_resolution(const std::string& group, const std::string& name, const analysis::Segmentation& cut,
                    std::size_t n_samples, double interval, Findings& findings);

/// Adds the tables history_NAME (first column `time`), amplitude_NAME and density_NAME (first column `frequency`).
/// `columns`: of the record, without its time.
void add_record(const std::string& name, const std::vector<double>& time, double interval,
                const std::vector<Table::Column>& columns, const Options& options, Findings& findings);

/// Components of [n][3] values as columns `what`_x, _y, _z.
std::vector<Table::Column> components(const std::string& what, const std::string& unit,
                                      const std::vector<double>& values);

}  // namespace coupler::study
