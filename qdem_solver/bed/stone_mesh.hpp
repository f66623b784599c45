// Which mesh of a stone is taken: the one with the largest stable step.
#pragma once

#include <string>
#include <vector>

#include "qdem_solver/bed/polyhedron.hpp"

namespace qdem::bed {

/// A template with its figures, or the reason why there is none.
struct Candidate {
  Template shape;
  double step = 0.0;              ///< largest stable step for a rock of unit wave speed [m]; 0: refused
  std::string refusal;            ///< empty: usable
  std::vector<std::size_t> tags;  ///< of the tetrahedra in the file they come from; empty: they come from none
};

/// What a mesh has to be.
struct MeshWish {
  int least_tets, most_tets;
  std::vector<double> sizes;  ///< edge lengths to try, falling [m]
  double
      lightest_corner;  ///< least share of the stone's mass that a surface node may carry: its contact rules the step
};

/// Of the first three meshes within the limits the one with the largest stable step.
Candidate best_mesh(const std::string& name, const Polyhedron& stone, const MeshWish& wish);

/// Largest stable step for a rock of unit wave speed [m].
double step_of_unit_rock(const Template& shape);

/// Median of the steps of those that are not refused; 0 if there is none.
double median_step(const std::vector<Candidate>& candidates);

}  // namespace qdem::bed
