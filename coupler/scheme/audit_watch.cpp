#include "coupler/scheme/audit_watch.hpp"

#include <fmt/format.h>

namespace coupler {

std::vector<std::string> AuditWatch::look(const Audit& audit, bool last) {
  struct Figure {
    const char* name;
    double value, limit, denominator, scale;
  };
  const Figure figures[] = {
      {"energy", audit.energy_defect_relative(), limits_.energy, audit.work(), limits_.work_scale},
      {"momentum", audit.momentum_defect_relative(), limits_.momentum, audit.impulse(), limits_.impulse_scale},
      {"moment", audit.moment_defect_relative(), limits_.moment, audit.impulse(), limits_.impulse_scale}};
  std::vector<std::string> beyond;
  for (std::size_t i = 0; i < told_.size(); ++i) {
    const auto& figure = figures[i];
    const bool counts = last || (figure.scale > 0.0 && figure.denominator > 0.1 * figure.scale);
    if (told_[i] || !counts || !(figure.value > figure.limit)) continue;
    told_[i] = true;
    beyond.push_back(fmt::format("the interface's {} defect is {:.2e} (coupling.audit.{} {:.2e})", figure.name,
                                 figure.value, figure.name, figure.limit));
  }
  return beyond;
}

void AuditWatch::exchange(proto::StateArchive& archive) {
  for (std::size_t i = 0; i < told_.size(); ++i) archive("audit/told_" + std::to_string(i), told_[i]);
}

}  // namespace coupler
