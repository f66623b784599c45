// Two sharp edges that cross: distance, normal, and how much of the contact is the edges' own.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "qdem_solver/contact/body_skin.hpp"
#include "qdem_solver/contact/closest_point.hpp"

namespace qdem {

/// Current geometry of an edge of a skin.
struct EdgeNow {
  std::array<Eigen::Vector3d, 2> x;
  HOUSE_HOST_DEVICE EdgeNow(const SkinView& skin, const double* positions, int edge) {
    const auto& nodes = skin.edges[edge].nodes;
    for (int k = 0; k < 2; ++k) x[k] = skin.at(positions, nodes[k]);
  }
  HOUSE_HOST_DEVICE Eigen::Vector3d direction() const { return x[1] - x[0]; }
  HOUSE_HOST_DEVICE Eigen::Vector3d at(double s) const { return x[0] + s * direction(); }
};

/// Outward direction of an edge: bisector of its two face normals, and the angle between it and either of them.
struct EdgeWedge {
  Eigen::Vector3d outward;
  double cos_half;  ///< cosine of half the angle between the face normals
  std::array<TriangleNow, 2> faces;
  HOUSE_HOST_DEVICE EdgeWedge(const SkinView& skin, const double* positions, int edge)
      : faces{TriangleNow(skin, positions, skin.edges[edge].triangles[0]),
              TriangleNow(skin, positions, skin.edges[edge].triangles[1])} {
    const Eigen::Vector3d n0 = faces[0].area_vector.normalized(), n1 = faces[1].area_vector.normalized();
    outward = (n0 + n1).normalized();
    cos_half = outward.dot(n0);
  }
  /// Least height of the two faces [m].
  HOUSE_HOST_DEVICE double height() const {
    double least2 = std::numeric_limits<double>::infinity();
    for (const TriangleNow& face : faces) {
      for (int k = 0; k < 3; ++k) {
        const double side2 = (face.x[(k + 1) % 3] - face.x[k]).squaredNorm();
        least2 = std::min(least2, face.area_vector.squaredNorm() / side2);
      }
    }
    return std::sqrt(least2);
  }
  /// Angle from the normal to the nearer face normal's side, negative between the two [rad].
  HOUSE_HOST_DEVICE double beyond(const Eigen::Vector3d& normal) const {
    return std::acos(std::clamp(outward.dot(normal), -1.0, 1.0)) - std::acos(std::min(cos_half, 1.0));
  }
  /// 1 for a normal between the two face normals and up to 15 degrees beyond, 0 from 30 degrees beyond.
  HOUSE_HOST_DEVICE double facing(const Eigen::Vector3d& normal) const {
    if (outward.dot(normal) >= cos_half) return 1.0;
    const double t = std::clamp((beyond(normal) - M_PI / 12) / (M_PI / 12), 0.0, 1.0);
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
  double s = 0.0, t = 0.0;                           ///< of the two nearest points
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, from b to a
  double overlap = 0.0;                              ///< [m]
  double facing = 0.0;                               ///< 1: both edges face each other, fading to 0
  EdgeEnd end;                                       ///< the deepest end
  double gap = 0.0;  ///< while not touching: the two sides cannot touch before they moved so far together [m]
  /// Share of the contact that the nodes do not carry already.
  HOUSE_HOST_DEVICE double share() const {
    const double r = end.side < 0 ? 0.0 : end.overlap / overlap;
    return facing * (1 - r * r);
  }
};

/// The end of either edge with the largest overlap against the other edge, for reach 2r. Through `d`, the signed
/// distance of the crossing, and l, the distance across the normal, an end is sqrt(d^2 + l^2) away outside and d + l
/// inside.
HOUSE_HOST_DEVICE inline EdgeEnd deepest_end(const EdgeNow& a, const EdgeNow& b, const Eigen::Vector3d& normal,
                                             double d, double reach) {
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

/// How fast the common normal of two edges turns as their sides move by T together: at most T times this [1/m].
HOUSE_HOST_DEVICE inline double turning(double length, double sine) {
  return 2 / (length * sine);
}

/// How far the two sides must move together before lines that cross outside a segment cross inside both: the end that
/// the other line passes has to come to it across the normal, while the normal turns and the lines are at most `reach`
/// apart. Half of that, for what is not linear in it. 0 for edges that are nearly parallel.
HOUSE_HOST_DEVICE inline double movement_to_cross(const Eigen::Vector3d& da, const Eigen::Vector3d& db,
                                                  const LinePair& pair, double reach) {
  const double aa = da.squaredNorm(), bb = db.squaredNorm(), ab = da.dot(db);
  const double sine2 = 1 - ab * ab / (aa * bb);
  if (!(sine2 > 1e-4)) return 0.0;
  const auto outside = [](double s) { return std::max({0.0, -s, s - 1}); };
  const double sine = std::sqrt(sine2);
  const double across = sine * std::max(outside(pair.s) * std::sqrt(aa), outside(pair.t) * std::sqrt(bb));
  return 0.5 * across / (1 + reach * turning(std::sqrt(std::min(aa, bb)), sine));
}

/// The same for a normal that lies outside a wedge, whichever way it points: it must turn, or the faces must.
HOUSE_HOST_DEVICE inline double movement_to_face(const Eigen::Vector3d& da, const Eigen::Vector3d& db,
                                                 const EdgeWedge& a, const EdgeWedge& b,
                                                 const Eigen::Vector3d& normal) {
  const double aa = da.squaredNorm(), bb = db.squaredNorm(), ab = da.dot(db);
  const double sine = std::sqrt(std::max(1 - ab * ab / (aa * bb), 1e-4));
  const double outside =
      std::min(std::max(a.beyond(-normal), b.beyond(normal)), std::max(a.beyond(normal), b.beyond(-normal)));
  const double rate = turning(std::sqrt(std::min(aa, bb)), sine) + 2 / std::min(a.height(), b.height());
  return 0.5 * std::max(outside - M_PI / 6, 0.0) / rate;
}

/// Contact of edge `edge_a` of skin a with edge `edge_b` of skin b, rounded to touch at distance `reach` = 2r.
///
/// The energy of an edge contact is k/2 (overlap^2 - overlap_end^2), with the deepest end's overlap: what the end's own
/// contact as a node does not hold already. It fades out as the nearest point slides off an edge and as edges become
/// parallel, so that no force jumps there and no contact counts twice.
HOUSE_HOST_DEVICE inline EdgeContact touch_edges(const SkinView& skin_a, int edge_a, const SkinView& skin_b, int edge_b,
                                                 const double* positions, double reach) {
  EdgeContact result;
  const EdgeNow a(skin_a, positions, edge_a), b(skin_b, positions, edge_b);
  const Eigen::Vector3d da = a.direction(), db = b.direction();
  const LinePair pair = closest_on_lines(a.x[0], da, b.x[0], db);
  if (!pair.crossing) {
    result.gap = std::max(movement_to_cross(da, db, pair, reach),
                          std::sqrt(segment_distance2(a.x[0], a.x[1], b.x[0], b.x[1])) - reach);
    return result;
  }
  const Eigen::Vector3d w = a.at(pair.s) - b.at(pair.t);
  if (w.squaredNorm() >= reach * reach) {
    result.gap = w.norm() - reach;
    return result;
  }
  const EdgeWedge wedge_a(skin_a, positions, edge_a), wedge_b(skin_b, positions, edge_b);
  result.normal = da.cross(db).normalized();
  if (result.normal.dot(wedge_b.outward - wedge_a.outward) < 0) result.normal = -result.normal;
  result.facing = wedge_a.facing(-result.normal) * wedge_b.facing(result.normal);
  if (!(result.facing > 0)) {
    result.gap = movement_to_face(da, db, wedge_a, wedge_b, result.normal);
    return result;
  }
  const double d = w.dot(result.normal);
  result.s = pair.s, result.t = pair.t;
  result.overlap = reach - d;
  result.end = deepest_end(a, b, result.normal, d, reach);
  result.touching = result.share() > 0;
  return result;
}

}  // namespace qdem
