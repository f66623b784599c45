#include "fem_solver/contact/contact_analysis.hpp"

#include <algorithm>

namespace fem {
namespace {

constexpr const char* where = "contact";

CurvePoint point_of(const PatchGrid& grid, const PatchField& bound, const Creepage& creepage,
                    const TangentialSolution& friction) {
  const auto all = zones(bound, friction.traction);
  const auto stick = std::count(all.begin(), all.end(), Zone::stick);
  const auto touching = (bound > 0).count();
  return {creepage, resultant(grid, friction.traction),
          touching > 0 ? static_cast<double>(stick) / static_cast<double>(touching) : 0.0};
}

}  // namespace

NormalSolution first_guess(const PatchGrid& grid, const PairElasticity& pair, double force) {
  const double modulus = pair.shear_modulus / (1 - pair.poisson);
  return {grid.zeros(), force / (modulus * std::max(grid.n_x * grid.dx, grid.n_y * grid.dy))};
}

void evaluate(const ContactCase& input, ContactResult& result) {
  const PatchField bound = input.friction * result.normal.pressure;
  result.ellipse = fit_ellipse(result.grid, result.normal.pressure);
  result.area = static_cast<double>((result.normal.pressure > 0).count()) * result.grid.area();
  result.zones = zones(bound, result.friction.traction);
  result.point = point_of(result.grid, bound, input.creepage, result.friction);
}

ContactResult analyse_contact(const ContactCase& input) {
  const PairElasticity pair = pair_elasticity(input.wheel, input.rail);
  ContactResult result;
  result.grid = input.grid;
  result.gap = contact_gap(input.geometry, input.grid);
  result.normal =
      NormalPatch(input.grid, pair)
          .at_force(result.gap.height, input.normal_force, first_guess(input.grid, pair, input.normal_force), where);
  require_inside(result.normal.pressure, where);

  const PatchField bound = input.friction * result.normal.pressure;
  const PatchVectors none = PatchVectors::zeros(input.grid);
  RollingPatch patch(input.grid, pair);
  result.friction = input.motion == ContactMotion::shift ? patch.shifted(bound, input.shift_x, input.shift_y, where)
                                                         : patch.steady(bound, none, input.creepage, where);
  evaluate(input, result);

  PatchVectors before = none;
  for (const double factor : input.curve_factors) {
    const Creepage creepage{factor * input.creepage.longitudinal, factor * input.creepage.lateral,
                            factor * input.creepage.spin};
    const TangentialSolution friction = patch.steady(bound, before, creepage, where);
    result.curve.push_back(point_of(input.grid, bound, creepage, friction));
    before = friction.traction;
  }
  return result;
}

}  // namespace fem
