#include "qdem_solver/bed/stone_mesh.hpp"

#include <algorithm>

#include "proto/error.hpp"
#include "qdem_solver/bed/gmsh_mesh.hpp"
#include "qdem_solver/engine/stability.hpp"

namespace qdem::bed {
namespace {

/// Share of the stone's mass that its lightest surface node carries.
double lightest_corner(const Template& shape) {
  double least = shape.volume();
  for (const int node : shape.surface_nodes) least = std::min(least, shape.node_volumes[node]);
  return least / shape.volume();
}

}  // namespace

double step_of_unit_rock(const Template& shape) {
  Material unit;
  unit.young = 1, unit.poisson = 0.25, unit.density = 1;
  return largest_stable_step(template_rates(shape, unit));
}

Candidate best_mesh(const std::string& name, const Polyhedron& stone, const MeshWish& wish) {
  Candidate best;
  int least_seen = 1 << 30, most_seen = 0;
  int n_good = 0;
  for (const double size : wish.sizes) {
    if (n_good == 3) break;  // finer meshes have smaller steps
    try {
      Template shape = mesh_polyhedron(name, stone, size);
      least_seen = std::min(least_seen, shape.n_tets()), most_seen = std::max(most_seen, shape.n_tets());
      if (shape.n_tets() < wish.least_tets || shape.n_tets() > wish.most_tets) continue;
      if (lightest_corner(shape) < wish.lightest_corner) continue;
      ++n_good;
      const double step = step_of_unit_rock(shape);
      if (step > best.step) best.step = step, best.shape = std::move(shape);
    } catch (const proto::Error& error) {
      best.refusal = error.what();  // the mesher failed at this size; the next may do
    }
  }
  if (best.step > 0) {
    best.refusal.clear();
  } else if (best.refusal.empty()) {
    best.refusal =
        std::to_string(least_seen) + " to " + std::to_string(most_seen) + " tetrahedra, or a corner too light";
  }
  best.shape.name = name;
  return best;
}

double median_step(const std::vector<Candidate>& candidates) {
  std::vector<double> steps;
  for (const Candidate& c : candidates) {
    if (c.step > 0) steps.push_back(c.step);
  }
  if (steps.empty()) return 0.0;
  std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
  return steps[steps.size() / 2];
}

}  // namespace qdem::bed
