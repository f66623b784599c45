#include "fem_solver/contact/rolling.hpp"

#include <cmath>
#include <sstream>

#include "proto/error.hpp"

namespace fem {
namespace {

constexpr double step_tolerance = 1e-6;    // of the traction in a step, over the largest
constexpr double steady_tolerance = 1e-5;  // of its change from step to step
constexpr double zone_tolerance = 1e-6;

}  // namespace

ShearResultant resultant(const PatchGrid& grid, const PatchVectors& traction) {
  ShearResultant sum;
  for (int j = 0; j < grid.n_y; ++j)
    for (int i = 0; i < grid.n_x; ++i) {
      sum.longitudinal += traction.x(i, j), sum.lateral += traction.y(i, j);
      sum.moment += grid.x(i) * traction.y(i, j) - grid.y(j) * traction.x(i, j);
    }
  return {sum.longitudinal * grid.area(), sum.lateral * grid.area(), sum.moment * grid.area()};
}

std::vector<Zone> zones(const PatchField& bound, const PatchVectors& traction) {
  const PatchField norm = traction.norm();
  std::vector<Zone> result(static_cast<std::size_t>(bound.size()), Zone::open);
  for (Eigen::Index k = 0; k < bound.size(); ++k)
    if (bound(k) > 0)
      result[static_cast<std::size_t>(k)] = norm(k) < (1 - zone_tolerance) * bound(k) ? Zone::stick : Zone::slip;
  return result;
}

RollingPatch::RollingPatch(const PatchGrid& grid, const PairElasticity& pair) : pair_(pair), patch_(grid, pair) {}

TangentialSolution RollingPatch::step(const PatchField& bound, const PatchVectors& before, const Creepage& creepage,
                                      double travel, const char* where) {
  const PatchGrid& grid = patch_.grid();
  if (!ahead_ || travel != travel_) {
    ahead_ = std::make_unique<TangentialInfluence>(grid, pair_, travel);
    travel_ = travel;
  }
  // The box holds the elements that were in contact and those that are.
  const PatchBox box = bounding_box(bound > 0 || before.norm() > 0);
  PatchVectors rigid = PatchVectors::zeros(grid);
  ahead_->add(box, {-before.x, -before.y}, rigid);
  // Tractions sit at x, slips are those of the way from x + travel to x: together a patch a quarter step ahead, from
  // whose centre the spin's lever counts. So the spin's force is of second order in the step.
  for (int j = 0; j < grid.n_y; ++j)
    for (int i = 0; i < grid.n_x; ++i) {
      rigid.x(i, j) += travel * (creepage.longitudinal - creepage.spin * grid.y(j));
      rigid.y(i, j) += travel * (creepage.lateral + creepage.spin * (grid.x(i) + travel / 4));
    }
  return patch_.solve(bound, rigid, before, step_tolerance, where);
}

TangentialSolution RollingPatch::steady(const PatchField& bound, const PatchVectors& before, const Creepage& creepage,
                                        const char* where) {
  const PatchGrid& grid = patch_.grid();
  TangentialSolution now{before, PatchVectors::zeros(grid)};
  std::ostringstream history;
  int iterations = 0;
  for (int k = 0; k < 20 * grid.n_x; ++k) {
    const PatchVectors last = now.traction;
    now = step(bound, last, creepage, grid.dx, where);
    iterations += now.iterations;
    const PatchVectors difference{now.traction.x - last.x, now.traction.y - last.y};
    const double change = difference.norm().maxCoeff();
    if (k % grid.n_x == 0) history << ' ' << change;
    if (change <= steady_tolerance * now.traction.norm().maxCoeff()) {
      now.iterations = iterations;
      return now;
    }
  }
  throw proto::Error(proto::ExitCode::numerics,
                     "rolling does not become steady (changes per step in Pa:" + history.str() + ")", where,
                     "check the creepages and the grid");
}

TangentialSolution RollingPatch::shifted(const PatchField& bound, double x, double y, const char* where) const {
  const PatchGrid& grid = patch_.grid();
  const PatchVectors rigid{grid.zeros() + x, grid.zeros() + y};
  return patch_.solve(bound, rigid, PatchVectors::zeros(grid), step_tolerance, where);
}

}  // namespace fem
