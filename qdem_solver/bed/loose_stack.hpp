// A loose stack of stones to pour from: boxes in rows, rows in levels.
#pragma once

#include <vector>

#include "qdem_solver/bed/gradation.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem::bed {

/// A part of a level's floor [m].
struct Rectangle {
  double x0, x1, y0, y1;
};

/// Places the stones, each turned at random, so that their boxes (grown by `gap` on every side) do not overlap: along x
/// in rows, rows along y, rectangle after rectangle, level after level from `bottom` upward, in the order given.
/// `scales`: of the stones' templates. Throws proto::Error (bad_data) if a stone is too large for every rectangle.
std::vector<Placement> stack_loosely(const std::vector<Template>& templates, const std::vector<Stone>& stones,
                                     const std::vector<double>& scales, const std::vector<Rectangle>& floor,
                                     double bottom, double gap, Random& random);

}  // namespace qdem::bed
