#include "qdem_solver/bed/porosity.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "qdem_solver/bed/polyhedron.hpp"
#include "qdem_solver/contact/closest_point.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

struct HalfSpace {
  Vector3d normal;
  double offset;  ///< inside: normal . x <= offset
};

struct Box {
  Vector3d low, high;
  explicit Box(const Vector3d& start) : low(start), high(start) {}
  void add(const Vector3d& x) { low = low.cwiseMin(x), high = high.cwiseMax(x); }
};

/// Sample points, and which of them are solid.
class Grid {
 public:
  Grid(const Vector3d& low, const Vector3d& high, double pitch) : low_(low) {
    for (int c = 0; c < 3; ++c) n_[c] = std::max(1, static_cast<int>(std::lround((high[c] - low[c]) / pitch)));
    step_ = (high - low).cwiseQuotient(n_.cast<double>());
    solid_.assign(static_cast<std::size_t>(n_.prod()), 0);
  }

  /// Makes points of the box, grown by `margin`, solid that are `inside`.
  template <class Inside>
  void fill(const Box& box, double margin, const Inside& inside) {
    const Vector3d first = (box.low.array() - margin - low_.array()).matrix().cwiseQuotient(step_);
    const Vector3d last = (box.high.array() + margin - low_.array()).matrix().cwiseQuotient(step_);
    const Eigen::Vector3i from = first.array().floor().cast<int>().max(0);
    const Eigen::Vector3i to = (last.array().ceil().cast<int>()).min(n_.array());
    if ((from.array() >= to.array()).any()) return;
    for (int k = from[2]; k < to[2]; ++k) {
      for (int j = from[1]; j < to[1]; ++j) {
        for (int i = from[0]; i < to[0]; ++i) {
          const Vector3d p = low_ + step_.cwiseProduct(Vector3d(i + 0.5, j + 0.5, k + 0.5));
          if (inside(p)) solid_[(static_cast<std::size_t>(k) * n_[1] + j) * n_[0] + i] = 1;
        }
      }
    }
  }

  double porosity() const {
    const auto n_solid = std::count(solid_.begin(), solid_.end(), 1);
    return 1 - static_cast<double>(n_solid) / static_cast<double>(solid_.size());
  }

 private:
  Vector3d low_, step_;
  Eigen::Vector3i n_;
  std::vector<char> solid_;
};

/// Half-space behind the triangle abc, grown by `margin`.
HalfSpace behind(const Vector3d& a, const Vector3d& b, const Vector3d& c, double margin) {
  const Vector3d normal = (b - a).cross(c - a).normalized();
  return {normal, normal.dot(a) + margin};
}

template <class HalfSpaces>
bool inside_all(const HalfSpaces& faces, const Vector3d& p) {
  return std::all_of(faces.begin(), faces.end(), [&](const HalfSpace& f) { return f.normal.dot(p) <= f.offset; });
}

/// One body's nodes now.
struct BodyNow {
  const Template& shape;
  std::vector<Vector3d> x;
  BodyNow(const Model& model, const State& state, int body) : shape(model.shape(body)) {
    for (int i = 0; i < shape.n_nodes(); ++i) x.push_back(state.position(model, body, i));
  }
  template <class Nodes>
  Box box(const Nodes& nodes) const {
    Box result(x[nodes[0]]);
    for (const int node : nodes) result.add(x[node]);
    return result;
  }
};

void fill_convex(Grid& grid, const BodyNow& body, double rounding) {
  std::vector<HalfSpace> faces;
  for (const Triangle& t : body.shape.triangles) {
    faces.push_back(behind(body.x[t.nodes[0]], body.x[t.nodes[1]], body.x[t.nodes[2]], rounding));
  }
  grid.fill(body.box(body.shape.surface_nodes), rounding, [&](const Vector3d& p) { return inside_all(faces, p); });
}

/// Tetrahedron by tetrahedron, then what is within the rounding of each triangle of the skin.
void fill_concave(Grid& grid, const BodyNow& body, double rounding) {
  for (const auto& t : body.shape.tets) {
    const Vector3d &a = body.x[t[0]], &b = body.x[t[1]], &c = body.x[t[2]], &d = body.x[t[3]];
    const std::array<HalfSpace, 4> faces = {behind(b, c, d, 0), behind(a, d, c, 0), behind(a, b, d, 0),
                                            behind(a, c, b, 0)};
    grid.fill(body.box(t), 0.0, [&](const Vector3d& p) { return inside_all(faces, p); });
  }
  if (!(rounding > 0)) return;
  for (const Triangle& t : body.shape.triangles) {
    const Vector3d &a = body.x[t.nodes[0]], &b = body.x[t.nodes[1]], &c = body.x[t.nodes[2]];
    const Vector3d area = (b - a).cross(c - a);
    grid.fill(body.box(t.nodes), rounding, [&](const Vector3d& p) {
      return closest_on_triangle(p, a, b, c, area).distance2 <= rounding * rounding;
    });
  }
}

}  // namespace

double porosity(const Model& model, const State& state, const Vector3d& low, const Vector3d& high, double pitch,
                double rounding) {
  Grid grid(low, high, pitch);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (model.bodies[b].kind != BodyKind::stone) continue;
    const BodyNow body(model, state, b);
    (is_convex(body.shape) ? fill_convex : fill_concave)(grid, body, rounding);
  }
  return grid.porosity();
}

}  // namespace qdem::bed
