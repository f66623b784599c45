#include "fem_solver/contact/half_space.hpp"

#include <cmath>

#include "proto/error.hpp"

namespace fem {
namespace {

constexpr double pi = 3.14159265358979323846;

// d2/dxdy of along(x, y) is y2/r3, of along(y, x) is x2/r3; their sum is the potential of 1/r.
double along(double x, double y) {
  return x == 0.0 ? 0.0 : x * std::asinh(y / std::abs(x));
}

// An antiderivative in x and y of the kernel, times pi G.
double corner(Influence influence, double poisson, double x, double y) {
  switch (influence) {
    case Influence::normal:
      return (1 - poisson) * (along(x, y) + along(y, x));
    case Influence::xx:
      return (1 - poisson) * along(x, y) + along(y, x);
    case Influence::yy:
      return along(x, y) + (1 - poisson) * along(y, x);
    case Influence::xy:
      return -poisson * std::hypot(x, y);
  }
  return 0.0;
}

}  // namespace

PairElasticity pair_elasticity(const ElasticBody& body_1, const ElasticBody& body_2) {
  if (!(body_1.young > 0 && body_2.young > 0))
    throw proto::Error(proto::ExitCode::bad_data, "a body in contact needs a positive modulus", "contact");
  const double soft_1 = 2 * (1 + body_1.poisson) / body_1.young, soft_2 = 2 * (1 + body_2.poisson) / body_2.young;
  const double shear = 2 / (soft_1 + soft_2);
  const double poisson = shear * (body_1.poisson * soft_1 + body_2.poisson * soft_2) / 2;
  const double k = shear * ((1 - 2 * body_1.poisson) * soft_1 - (1 - 2 * body_2.poisson) * soft_2) / 4;
  if (std::abs(k) > 0.05)
    throw proto::Error(proto::ExitCode::bad_data,
                       "the materials of wheel and rail differ so much that pressure and shear act on each other",
                       "contact", "take materials with a difference parameter K below 0.05");
  return {shear, poisson, k};
}

InfluenceTable::InfluenceTable(const PatchGrid& grid, const PairElasticity& pair, Influence influence, double shift)
    : n_x_(grid.n_x), n_y_(grid.n_y), values_(2 * grid.n_x - 1, 2 * grid.n_y - 1) {
  const double scale = 1 / (pi * pair.shear_modulus);
  PatchField corners(2 * n_x_, 2 * n_y_);
  for (int j = 0; j < 2 * n_y_; ++j)
    for (int i = 0; i < 2 * n_x_; ++i)
      corners(i, j) =
          scale * corner(influence, pair.poisson, (i - n_x_ + 0.5) * grid.dx + shift, (j - n_y_ + 0.5) * grid.dy);
  const int rows = 2 * n_x_ - 1, columns = 2 * n_y_ - 1;
  values_ = corners.bottomRightCorner(rows, columns) - corners.bottomLeftCorner(rows, columns) -
            corners.topRightCorner(rows, columns) + corners.topLeftCorner(rows, columns);
}

void InfluenceTable::add(const PatchBox& box, const PatchField& traction, PatchField& displacement) const {
  for (int source_j = box.j_begin; source_j < box.j_begin + box.n_j; ++source_j)
    for (int source_i = box.i_begin; source_i < box.i_begin + box.n_i; ++source_i) {
      const double value = traction(source_i, source_j);
      if (value == 0.0) continue;
      displacement.block(box.i_begin, box.j_begin, box.n_i, box.n_j) +=
          value * values_.block(box.i_begin - source_i + n_x_ - 1, box.j_begin - source_j + n_y_ - 1, box.n_i, box.n_j);
    }
}

}  // namespace fem
