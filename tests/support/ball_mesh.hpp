// Meshes for tests: a ball from an octahedron of regular layers.
#pragma once

#include <map>

#include "tests/support/box_mesh.hpp"

namespace tests {

namespace detail {

/// Point of the octahedron |x| + |y| + |z| <= 1 onto the ball of radius 1, along its ray.
inline Eigen::Vector3d on_ball(const Eigen::Vector3d& p) {
  return p.norm() > 0 ? Eigen::Vector3d(p * p.lpNorm<1>() / p.norm()) : p;
}

}  // namespace detail

/// Ball about the origin with `layers` of elements from centre to surface. An octant is the sixth a >= b >= c of a cube
/// of bricks, so that no element has more than one face on the surface.
inline Mesh ball_mesh(int layers, double radius) {
  const Mesh cube = box_mesh({layers, layers, layers}, Eigen::Vector3d::Constant(layers));
  Mesh ball;
  std::map<std::array<long, 3>, int> ids;
  const auto id = [&](const Eigen::Vector3d& p) {
    const auto [found, is_new] =
        ids.try_emplace({std::lround(p[0]), std::lround(p[1]), std::lround(p[2])}, static_cast<int>(ball.nodes.size()));
    if (is_new) ball.nodes.push_back(radius * detail::on_ball(p / layers));
    return found->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const Eigen::Vector3d sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
    for (const auto& tet : cube.tets) {
      std::array<int, 4> corners;
      bool inside = true;
      for (int k = 0; k < 4; ++k) {
        const Eigen::Vector3d& p = cube.nodes[tet[k]];
        const Eigen::Vector3d q(p[0] - p[1], p[1] - p[2], p[2]);
        inside = inside && q.minCoeff() > -0.5;
        if (inside) corners[k] = id(sign.cwiseProduct(q));
      }
      if (!inside) continue;
      if (sign.prod() < 0) std::swap(corners[2], corners[3]);
      ball.tets.push_back(corners);
    }
  }
  return ball;
}

}  // namespace tests
