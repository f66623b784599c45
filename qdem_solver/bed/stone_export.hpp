// The stones of a case as surfaces to look at.
#pragma once

#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "qdem_solver/bed/rough_surface.hpp"

namespace qdem::bed {

/// Templates of a case as files.
struct StoneExport {
  std::vector<std::string> files;
  std::vector<std::string> notes;  ///< of make_stone_templates()
};

/// Writes the skin of every template of the case into `folder`, which exists: NAME.stl, in millimetres at the sieve
/// size d50, with `roughness` in sieve sizes. The same case and roughness give the same bytes. Throws proto::Error:
/// config, what make_stone_templates() throws, cannot_create.
StoneExport export_stones(const proto::CaseFile& file, const std::string& folder, const Roughness& roughness);

}  // namespace qdem::bed
