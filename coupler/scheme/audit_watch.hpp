// Holds the audit's figures against the limits of the case.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "coupler/scheme/audit.hpp"
#include "proto/case/coupling.hpp"

namespace coupler {

/// Says once of every figure that it is beyond its limit. A running figure counts once its denominator has passed a
/// tenth of the scale that the case declares; without a scale only that of the whole run counts.
class AuditWatch {
 public:
  explicit AuditWatch(const proto::AuditLimits& limits) : limits_(limits) {}

  /// After a window (`last`: of the run). Returns what is newly beyond its limit, figure, value and key by name.
  std::vector<std::string> look(const Audit& audit, bool last);

  /// What was said already.
  void exchange(proto::StateArchive& archive);

 private:
  proto::AuditLimits limits_;
  std::array<bool, 3> told_ = {};
};

}  // namespace coupler
