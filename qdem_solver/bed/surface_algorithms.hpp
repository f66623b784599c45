// What CGAL does to closed triangle surfaces.
#pragma once

#include <optional>

#include "qdem_solver/bed/polyhedron.hpp"

namespace qdem::bed {

/// Turns facets so that neighbours agree on the outside. False when no turning can do that, or where parts of the
/// surface touch in a corner; the shape is then of no use.
bool make_consistent(Polyhedron& shape);

/// Takes away facets without area that have three corners on a line. Needs a closed, consistent surface. Returns how
/// many there were; none when it fails.
std::optional<int> remove_flat_facets(Polyhedron& shape);

/// A corner of a facet that cuts through another one, if there is such a facet. Needs a closed, consistent surface.
std::optional<Eigen::Vector3d> self_crossing(const Polyhedron& shape);

/// The surface with about `n_facets` facets: edges collapse in the order, and to the places, that change volume and
/// shape least (Lindstrom and Turk 1998). A surface with fewer facets stays as it is.
Polyhedron coarsened(const Polyhedron& shape, int n_facets);

}  // namespace qdem::bed
