// The skin point nearest to a node, with a signed distance.
#pragma once

#include "qdem_solver/contact/body_skin.hpp"
#include "qdem_solver/contact/closest_point.hpp"

namespace qdem {

/// Nearest point of a skin to a node.
struct SurfacePoint {
  int triangle = -1;        ///< -1: there was no candidate
  Eigen::Vector3d weights;  ///< barycentric in that triangle
  Eigen::Vector3d normal;   ///< unit, from the skin point to the node; from node to skin point inside the body
  double distance = 0.0;    ///< negative inside the body [m]
};

/// Nearest point of `skin` to `p` over the triangles [first, last), signed by the face normal.
///
/// Where the nearest point lies on an edge or a corner, several triangles share it. The one whose plane is farthest
/// from p decides the sign: of the triangles around a nearest point it sees p from the right side (Baerentzen and
/// Aanaes 2005 use angle-weighted normals for the same purpose). Equal distances are told by a relative 1e-8.
HOUSE_HOST_DEVICE inline SurfacePoint nearest_surface_point(const SkinView& skin, const double* positions,
                                                            const Eigen::Vector3d& p, const int* first,
                                                            const int* last) {
  SurfacePoint result;
  TrianglePoint best{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.0, false};
  double best_height = 0.0;  // of p over the plane of the triangle, signed
  Eigen::Vector3d best_normal = Eigen::Vector3d::UnitZ();
  for (const int* it = first; it != last; ++it) {
    const TriangleNow triangle(skin, positions, *it);
    const TrianglePoint point =
        closest_on_triangle(p, triangle.x[0], triangle.x[1], triangle.x[2], triangle.area_vector);
    const double tie = 1e-8 * point.distance2;
    if (result.triangle >= 0 && point.distance2 > best.distance2 + tie) continue;
    const Eigen::Vector3d normal = triangle.area_vector.normalized();
    const double height = normal.dot(p - triangle.x[0]);
    const bool nearer = result.triangle < 0 || point.distance2 < best.distance2 - tie;
    if (!nearer && std::abs(height) <= std::abs(best_height)) continue;
    best = point, best_height = height, best_normal = normal;
    result.triangle = *it;
  }
  if (result.triangle < 0) return result;
  const double sign = best_height < 0 ? -1.0 : 1.0;
  const double size = std::sqrt(best.distance2);
  result.weights = best.weights;
  result.distance = sign * size;
  result.normal = best.interior || !(size > 1e-12) ? best_normal : Eigen::Vector3d(best.offset * (sign / size));
  return result;
}

}  // namespace qdem
