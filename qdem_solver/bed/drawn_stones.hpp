// The stones that a bed is made from, before any of them is poured.
#pragma once

#include <string>
#include <vector>

#include "qdem_solver/bed/gradation.hpp"
#include "qdem_solver/bed/settings.hpp"
#include "qdem_solver/model/model.hpp"

namespace qdem::bed {

struct DrawnStones {
  std::vector<Template> templates;
  std::vector<std::string> notes;  ///< see StoneTemplates
  std::vector<Stone> layer;        ///< under the sleeper's bottom level
  std::vector<Stone> crib;         ///< above it: crib and shoulder
};

/// Volume of a stone of a template and sieve size [m3], its surface rounded by `rounding` [m] within that size.
double envelope_volume(const Template& shape, double size, double rounding);

/// Those of the scene: none, one of the first template and the size d50, or as many as fill the layer and the crib at
/// the target porosity. Throws proto::Error as make_stone_templates().
DrawnStones draw_bed(const Settings& settings, double rounding, Random& random);

}  // namespace qdem::bed
