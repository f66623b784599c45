// Surfaces that look as if a scanner had seen them.
#pragma once

#include "qdem_solver/bed/polyhedron.hpp"
#include "qdem_solver/bed/random.hpp"

namespace qdem::bed {

/// What a scan adds to a smooth polyhedron.
struct Roughness {
  double height = 0.0;   ///< root mean square displacement along the normal, in units of the shape; 0: none
  int least_facets = 0;  ///< facets are cut into four until there are so many
};

/// The shape with finer facets and uneven faces: waves of a third of a unit to one unit, and noise from corner to
/// corner.
Polyhedron roughened(Polyhedron shape, const Roughness& roughness, Random& random);

}  // namespace qdem::bed
