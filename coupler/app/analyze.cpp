// `coupler analyze`: spectra, responses, modes, fields and forces of a run that was made before.
#include <fmt/format.h>

#include "coupler/app/options.hpp"
#include "coupler/study/analyses.hpp"
#include "proto/error.hpp"
#include "proto/result/provenance.hpp"

namespace coupler {

int analyze_run(const AnalyzeOptions& options) {
  for (const auto& band : {options.study.low, options.study.high}) {
    if (band.low < band.high) continue;
    throw proto::Error(proto::ExitCode::usage, fmt::format("a band from {:g} to {:g} Hz is empty", band.low, band.high),
                       "command line", "give the lower frequency first");
  }
  const std::string out = options.out.empty() ? options.folder + "/analysis" : options.out;
  const auto findings = study::analyse(options.folder, options.study);
  proto::Attributes attributes = study::RunFiles(options.folder).provenance();
  attributes.insert(attributes.begin(), {{"program", std::string("coupler analyze")},
                                         {"version", proto::project_version()},
                                         {"source", proto::source_description()}});
  study::write_findings(findings, out, attributes);
  fmt::print("{}", study::summary_text(findings, options.folder, out));
  return 0;
}

}  // namespace coupler
