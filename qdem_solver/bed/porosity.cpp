#include "qdem_solver/bed/porosity.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

struct HalfSpace {
  Vector3d normal;
  double offset;  ///< inside: normal . x <= offset
};

std::vector<HalfSpace> faces_of(const Model& model, const State& state, int body, double rounding) {
  std::vector<HalfSpace> faces;
  for (const Triangle& t : model.shape(body).triangles) {
    const Vector3d a = state.position(model, body, t.nodes[0]);
    const Vector3d normal =
        (state.position(model, body, t.nodes[1]) - a).cross(state.position(model, body, t.nodes[2]) - a).normalized();
    faces.push_back({normal, normal.dot(a) + rounding});
  }
  return faces;
}

}  // namespace

double porosity(const Model& model, const State& state, const Vector3d& low, const Vector3d& high, double pitch,
                double rounding) {
  Eigen::Vector3i n;
  for (int c = 0; c < 3; ++c) n[c] = std::max(1, static_cast<int>(std::lround((high[c] - low[c]) / pitch)));
  const Vector3d step = (high - low).cwiseQuotient(n.cast<double>());
  std::vector<char> solid(static_cast<std::size_t>(n.prod()), 0);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (model.bodies[b].kind != BodyKind::stone) continue;
    Vector3d box_low = state.position(model, b, 0), box_high = box_low;
    for (const int node : model.shape(b).surface_nodes) {
      const Vector3d x = state.position(model, b, node);
      box_low = box_low.cwiseMin(x), box_high = box_high.cwiseMax(x);
    }
    const Vector3d first = (box_low.array() - rounding - low.array()).matrix().cwiseQuotient(step);
    const Vector3d last = (box_high.array() + rounding - low.array()).matrix().cwiseQuotient(step);
    const Eigen::Vector3i from = first.array().floor().cast<int>().max(0);
    const Eigen::Vector3i to = (last.array().ceil().cast<int>()).min(n.array());
    if ((from.array() >= to.array()).any()) continue;
    const auto faces = faces_of(model, state, b, rounding);
    for (int k = from[2]; k < to[2]; ++k) {
      for (int j = from[1]; j < to[1]; ++j) {
        for (int i = from[0]; i < to[0]; ++i) {
          const Vector3d p = low + step.cwiseProduct(Vector3d(i + 0.5, j + 0.5, k + 0.5));
          const bool inside =
              std::all_of(faces.begin(), faces.end(), [&](const HalfSpace& f) { return f.normal.dot(p) <= f.offset; });
          if (inside) solid[(static_cast<std::size_t>(k) * n[1] + j) * n[0] + i] = 1;
        }
      }
    }
  }
  const auto n_solid = std::count(solid.begin(), solid.end(), 1);
  return 1 - static_cast<double>(n_solid) / static_cast<double>(solid.size());
}

}  // namespace qdem::bed
