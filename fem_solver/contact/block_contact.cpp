#include "fem_solver/contact/block_contact.hpp"

#include <cmath>

#include "fem_solver/contact/block_compliance.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

constexpr const char* where = "contact of blocks";
constexpr double shear_tolerance = 1e-6;

// Of a node on a plane of symmetry half the element lies in the quarter.
PatchField shares(const PatchGrid& quarter) {
  PatchField share = PatchField::Ones(quarter.n_x, quarter.n_y);
  share.row(0) /= 2, share.col(0) /= 2;
  return share;
}

// `sign`: of the value at -x, and at -y, over that at x, y.
PatchField mirrored(const PatchField& quarter, double sign) {
  const Eigen::Index n = quarter.rows(), m = quarter.cols();
  PatchField whole(2 * n - 1, 2 * m - 1);
  for (Eigen::Index j = 0; j < 2 * m - 1; ++j)
    for (Eigen::Index i = 0; i < 2 * n - 1; ++i) {
      const Eigen::Index k = std::abs(i - n + 1), l = std::abs(j - m + 1);
      whole(i, j) = quarter(k, l) * (i < n - 1 ? sign : 1.0) * (j < m - 1 ? sign : 1.0);
    }
  return whole;
}

void require_covered(const ContactCase& input) {
  if (!input.hertz || input.motion != ContactMotion::shift || input.shift_y != 0)
    throw proto::Error(proto::ExitCode::config, "blocks cover two radii and a shift along the rail only",
                       "contact.bodies",
                       "give rail_crown_radius_m and motion = \"shift\", or take bodies = \"half_space\"");
}

}  // namespace

ContactResult analyse_block_contact(const ContactCase& input) {
  require_covered(input);
  const BlockShape shape{input.hertz->semi_axis_x, input.hertz->semi_axis_y,
                         static_cast<int>(std::lround(input.hertz->semi_axis_x / input.grid.dx)),
                         input.grid.n_x * input.grid.dx / 2 / input.hertz->semi_axis_x};
  const PairElasticity pair = pair_elasticity(input.wheel, input.rail);
  auto normal_compliance = std::make_unique<BlockNormal>(shape, input.wheel, input.rail);
  const PatchGrid quarter = normal_compliance->grid();
  PatchField gap = quarter.zeros();
  for (int j = 0; j < quarter.n_y; ++j)
    for (int i = 0; i < quarter.n_x; ++i)
      gap(i, j) = (input.geometry.wheel_curvature * std::pow(i * quarter.dx, 2) +
                   input.geometry.crown_curvature * std::pow(j * quarter.dy, 2)) /
                  2;
  const NormalPatch pressing(quarter, std::move(normal_compliance));
  const NormalSolution normal =
      pressing.at_force(gap, input.normal_force / 4, first_guess(quarter, pair, input.normal_force), where);
  const PatchField bound = input.friction * normal.pressure;
  const TangentialPatch shearing(quarter, std::make_unique<BlockShear>(shape, input.wheel, input.rail));
  const PatchVectors rigid{quarter.zeros() + input.shift_x, quarter.zeros()};
  const TangentialSolution friction =
      shearing.solve(bound, rigid, PatchVectors::zeros(quarter), shear_tolerance, where);

  const PatchField share = shares(quarter);
  ContactResult result;
  result.grid = {2 * quarter.n_x - 1, 2 * quarter.n_y - 1, quarter.dx, quarter.dy};
  result.gap.height = mirrored(gap, 1.0);
  result.normal = {mirrored(normal.pressure / share, 1.0), normal.approach, 4 * normal.force, 4 * normal.tangent,
                   normal.iterations};
  result.friction = {{mirrored(friction.traction.x / share, 1.0), mirrored(friction.traction.y / share, -1.0)},
                     {mirrored(friction.slip.x, 1.0), mirrored(friction.slip.y, -1.0)},
                     friction.iterations};
  require_inside(result.normal.pressure, where);
  evaluate(input, result);
  return result;
}

}  // namespace fem
