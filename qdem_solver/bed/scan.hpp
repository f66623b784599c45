// A stone's surface from a scanner: repaired where that is safe, else refused.
#pragma once

#include <string>
#include <vector>

#include "qdem_solver/bed/polyhedron.hpp"

namespace qdem::bed {

struct Scan {
  Polyhedron shape;                  ///< closed, simple, outward, of one part; in the unit of the file
  std::vector<std::string> repairs;  ///< what was done to it, in words
};

/// Reads a surface (STL, OBJ). Repaired: corners within 1e-6 of the stone's extent of each other become one; facets
/// without area and doubled facets are left out; facets are turned to one side, and that side outward. Throws
/// proto::Error (bad_data) for a surface that is open, has an edge of more than two facets, is one-sided, has more than
/// one part or cuts through itself, with the place.
Scan read_scan(const std::string& path);

}  // namespace qdem::bed
