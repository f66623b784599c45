// Two sharp edges that cross: distance, normal, and how much of the contact is the edges' own.
#pragma once

#include <algorithm>
#include <cmath>

#include "qdem_solver/contact/body_skin.hpp"
#include "qdem_solver/contact/closest_point.hpp"

namespace qdem {

/// Current geometry of an edge of a skin.
struct EdgeNow {
  std::array<Eigen::Vector3d, 2> x;
  EdgeNow(const BodySkin& skin, const double* positions, int edge) {
    const auto& nodes = skin.shape->edges[edge].nodes;
    for (int k = 0; k < 2; ++k) x[k] = skin.at(positions, nodes[k]);
  }
  Eigen::Vector3d direction() const { return x[1] - x[0]; }
  Eigen::Vector3d at(double s) const { return x[0] + s * direction(); }
};

/// Outward direction of an edge: bisector of its two face normals, and the angle between it and either of them.
struct EdgeWedge {
  Eigen::Vector3d outward;
  double cos_half;  ///< cosine of half the angle between the face normals
  EdgeWedge(const BodySkin& skin, const double* positions, int edge) {
    const auto& faces = skin.shape->edges[edge].triangles;
    const Eigen::Vector3d n0 = TriangleNow(skin, positions, faces[0]).area_vector.normalized();
    const Eigen::Vector3d n1 = TriangleNow(skin, positions, faces[1]).area_vector.normalized();
    outward = (n0 + n1).normalized();
    cos_half = outward.dot(n0);
  }
  /// 1 for a normal between the two face normals and up to 15 degrees beyond, 0 from 30 degrees beyond.
  double facing(const Eigen::Vector3d& normal) const {
    const double cosine = outward.dot(normal);
    if (cosine >= cos_half) return 1.0;
    const double beyond = std::acos(std::max(cosine, -1.0)) - std::acos(std::min(cos_half, 1.0));
    const double t = std::clamp((beyond - M_PI / 12) / (M_PI / 12), 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
  }
};

/// An end of one edge that is near the other edge.
struct EdgeEnd {
  int side = -1;           ///< 0: end of edge a, 1: end of edge b, -1: no end is within reach
  int end = 0;             ///< 0 or 1
  double parameter = 0.0;  ///< of the nearest point on the other edge
  Eigen::Vector3d normal;  ///< unit, from b to a
  double overlap = 0.0;    ///< [m]
};

struct EdgeContact {
  bool touching = false;
  double s = 0.0, t = 0.0;  ///< of the two nearest points
  Eigen::Vector3d normal;   ///< unit, from b to a
  double overlap = 0.0;     ///< [m]
  double facing = 0.0;      ///< 1: both edges face each other, fading to 0
  EdgeEnd end;              ///< the deepest end
  /// Share of the contact that the nodes do not carry already.
  double share() const {
    const double r = end.side < 0 ? 0.0 : end.overlap / overlap;
    return facing * (1 - r * r);
  }
};

/// The end of either edge with the largest overlap against the other edge, for reach 2r. Through `d`, the signed
/// distance of the crossing, and l, the distance across the normal, an end is sqrt(d^2 + l^2) away outside and d + l
/// inside.
inline EdgeEnd deepest_end(const EdgeNow& a, const EdgeNow& b, const Eigen::Vector3d& normal, double d, double reach) {
  EdgeEnd best;
  for (int side = 0; side < 2; ++side) {
    const EdgeNow &own = side == 0 ? a : b, &other = side == 0 ? b : a;
    for (int end = 0; end < 2; ++end) {
      const double parameter = closest_on_segment(own.x[end], other.x[0], other.x[1]);
      Eigen::Vector3d w = own.x[end] - other.at(parameter);
      if (side == 1) w = -w;
      const double size = w.norm();
      const double distance = d >= 0 ? size : d + (w - d * normal).norm();
      const double overlap = reach - distance;
      if (overlap <= 0 || (best.side >= 0 && overlap <= best.overlap)) continue;
      best.side = side, best.end = end, best.parameter = parameter, best.overlap = overlap;
      best.normal = size > 1e-12 ? Eigen::Vector3d(w / size) : normal;
    }
  }
  return best;
}

/// Contact of edge `edge_a` of skin a with edge `edge_b` of skin b, rounded to touch at distance `reach` = 2r.
///
/// The energy of an edge contact is k/2 (overlap^2 - overlap_end^2), with the deepest end's overlap: what the end's own
/// contact as a node does not hold already. It fades out as the nearest point slides off an edge and as edges become
/// parallel, so that no force jumps there and no contact counts twice.
inline EdgeContact touch_edges(const BodySkin& skin_a, int edge_a, const BodySkin& skin_b, int edge_b,
                               const double* positions, double reach) {
  EdgeContact result;
  const EdgeNow a(skin_a, positions, edge_a), b(skin_b, positions, edge_b);
  const Eigen::Vector3d da = a.direction(), db = b.direction();
  const LinePair pair = closest_on_lines(a.x[0], da, b.x[0], db);
  if (!pair.crossing) return result;
  const Eigen::Vector3d w = a.at(pair.s) - b.at(pair.t);
  if (w.squaredNorm() >= reach * reach) return result;
  const EdgeWedge wedge_a(skin_a, positions, edge_a), wedge_b(skin_b, positions, edge_b);
  result.normal = da.cross(db).normalized();
  if (result.normal.dot(wedge_b.outward - wedge_a.outward) < 0) result.normal = -result.normal;
  result.facing = wedge_a.facing(-result.normal) * wedge_b.facing(result.normal);
  if (!(result.facing > 0)) return result;
  const double d = w.dot(result.normal);
  result.s = pair.s, result.t = pair.t;
  result.overlap = reach - d;
  result.end = deepest_end(a, b, result.normal, d, reach);
  result.touching = result.share() > 0;
  return result;
}

}  // namespace qdem
