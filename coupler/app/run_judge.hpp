// Judges a run: advice before it, the audit and its limits during it, what was observed after it.
#pragma once

#include <spdlog/logger.h>

#include <optional>
#include <string>
#include <vector>

#include "coupler/app/case_input.hpp"
#include "coupler/record/summary.hpp"
#include "coupler/scheme/audit.hpp"
#include "coupler/scheme/audit_watch.hpp"
#include "coupler/scheme/observation.hpp"

namespace coupler {

/// Writes what it finds to the log, to stderr (warnings) and into the summary.
class RunJudge {
 public:
  /// All must outlive the object.
  RunJudge(const CaseInput& input, spdlog::logger& log, Summary& summary);

  /// Before the first window, with the facts of the participants in the summary. Throws proto::Error (config) when the
  /// case's explicit scheme is not stable and the case does not accept that.
  void advise(const std::vector<proto::PadLaw>& laws);

  /// Takes a window of the march; returns its defects.
  WindowAudit add(const WindowRecord& record);
  const Audit& audit() const { return audit_; }

  /// Holds the audit against the limits of the case (`last`: after the run's last window). Returns the scheme to go on
  /// with, if it is to be switched. Throws proto::Error (numerics) with `stage` when the run is to stop.
  std::optional<proto::Scheme> judge(const std::string& stage, bool last);

  /// After the last window.
  void observe();

  /// Brings the summary up to what was added.
  void report();
  /// The sums of audit and observation.
  void exchange(proto::StateArchive& archive);

  /// To log, stderr and summary.
  void warn(const std::string& text);

 private:

  const CaseInput& input_;
  spdlog::logger& log_;
  Summary& summary_;
  Audit audit_;
  AuditWatch watch_;
  Observation seen_;
};

}  // namespace coupler
