#include "qdem_solver/bed/polyhedron.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace qdem::bed {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double flush = 1e-6;  // angle of facets that count as one [rad]

struct Box {
  Vector3d low, high;
  Vector3d size() const { return high - low; }
};

Box box_along(const Matrix3d& axes, const std::vector<Vector3d>& points) {
  Box box{axes * points[0], axes * points[0]};
  for (const Vector3d& p : points) {
    const Vector3d x = axes * p;
    box.low = box.low.cwiseMin(x), box.high = box.high.cwiseMax(x);
  }
  return box;
}

/// Axes of the smallest box with one side on a facet and one side along an edge of that facet.
Matrix3d smallest_box(const Polyhedron& shape) {
  Matrix3d best = Matrix3d::Identity();
  double least = std::numeric_limits<double>::infinity();
  for (const auto& face : shape.faces) {
    for (int k = 0; k < 3; ++k) {
      const Vector3d& a = shape.corners[face[k]];
      const Vector3d along = (shape.corners[face[(k + 1) % 3]] - a).normalized();
      const Vector3d normal = along.cross(shape.corners[face[(k + 2) % 3]] - a).normalized();
      Matrix3d axes;
      axes.row(0) = along, axes.row(1) = normal.cross(along), axes.row(2) = normal;
      const double size = box_along(axes, shape.corners).size().prod();
      if (size < least * (1 - 1e-9)) least = size, best = axes;  // of equal boxes the first, whatever round-off says
    }
  }
  return best;
}

}  // namespace

double volume(const Polyhedron& shape) {
  const Vector3d origin = shape.corners[0];
  double sum = 0.0;
  for (const auto& face : shape.faces) {
    const Vector3d a = shape.corners[face[0]] - origin, b = shape.corners[face[1]] - origin;
    sum += a.dot(b.cross(shape.corners[face[2]] - origin));
  }
  return sum / 6;
}

int count_parts(const Polyhedron& shape) {
  std::vector<int> owner(shape.faces.size());
  std::iota(owner.begin(), owner.end(), 0);
  const auto root = [&](int face) {
    while (owner[face] != face) face = owner[face] = owner[owner[face]];
    return face;
  };
  std::map<std::pair<int, int>, int> first;
  for (int f = 0; f < static_cast<int>(shape.faces.size()); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto edge = std::minmax(shape.faces[f][k], shape.faces[f][(k + 1) % 3]);
      owner[root(f)] = root(first.emplace(edge, f).first->second);
    }
  }
  int n_parts = 0;
  for (int f = 0; f < static_cast<int>(owner.size()); ++f) n_parts += owner[f] == f;
  return n_parts;
}

Polyhedron skin_of(const Template& shape) {
  std::vector<int> number(shape.nodes.size(), -1);
  Polyhedron skin;
  for (const int node : shape.surface_nodes) {
    number[node] = static_cast<int>(skin.corners.size());
    skin.corners.push_back(shape.nodes[node]);
  }
  for (const Triangle& t : shape.triangles) {
    skin.faces.push_back({number[t.nodes[0]], number[t.nodes[1]], number[t.nodes[2]]});
  }
  return skin;
}

bool is_hollow(const Template& shape, const Edge& edge) {
  const auto& a = shape.triangles[edge.triangles[0]].nodes;
  const Vector3d& start = shape.nodes[edge.nodes[0]];
  const Vector3d normal =
      (shape.nodes[a[1]] - shape.nodes[a[0]]).cross(shape.nodes[a[2]] - shape.nodes[a[0]]).normalized();
  for (const int node : shape.triangles[edge.triangles[1]].nodes) {
    if (node == edge.nodes[0] || node == edge.nodes[1]) continue;
    const Vector3d to = shape.nodes[node] - start;
    return normal.dot(to) > flush * to.norm();
  }
  return false;
}

bool is_convex(const Template& shape) {
  return std::none_of(shape.edges.begin(), shape.edges.end(), [&](const Edge& edge) { return is_hollow(shape, edge); });
}

SieveFrame sieve_frame(const Polyhedron& shape) {
  const Matrix3d axes = smallest_box(shape);
  const Box box = box_along(axes, shape.corners);
  std::array<int, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return box.size()[i] > box.size()[j]; });
  SieveFrame frame;
  for (int k = 0; k < 2; ++k) frame.axes.row(k) = axes.row(order[k]);
  frame.axes.row(2) = frame.axes.row(0).cross(frame.axes.row(1));
  frame.centre = axes.transpose() * (0.5 * (box.low + box.high));
  frame.size = box.size()[order[1]];
  return frame;
}

Polyhedron at_sieve_size(Polyhedron shape) {
  const SieveFrame frame = sieve_frame(shape);
  for (Vector3d& x : shape.corners) x = frame(x);
  return shape;
}

}  // namespace qdem::bed
