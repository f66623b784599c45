// Closest points between a point and a triangle, a point and a segment, and two lines.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "proto/span.hpp"

namespace qdem {

/// Point of segment ab nearest to p: a + t (b - a), 0 <= t <= 1. A segment of no length gives t = 0.
HOUSE_HOST_DEVICE inline double closest_on_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                                   const Eigen::Vector3d& b) {
  const Eigen::Vector3d e = b - a;
  const double length2 = e.squaredNorm();
  if (!(length2 > 0)) return 0.0;
  const double t = e.dot(p - a) / length2;
  return t < 0 ? 0.0 : (t > 1 ? 1.0 : t);
}

/// Where the triangle point nearest to a given point lies.
struct TrianglePoint {
  Eigen::Vector3d weights;  ///< barycentric, in [0, 1], sum 1
  Eigen::Vector3d offset;   ///< from the triangle's point to the given point [m]
  double distance2;         ///< |offset|^2 [m2]
  bool interior;            ///< in the face, not on an edge or corner
};

/// Point of triangle abc nearest to p. `area_vector` = (b - a) x (c - a).
///
/// Inside the prism over the triangle the projection is it. Outside, only the edges that p lies beyond are visible from
/// p, and the nearest point is on one of them. A triangle without area is treated as its edges.
HOUSE_HOST_DEVICE inline TrianglePoint closest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                                           const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                                           const Eigen::Vector3d& area_vector) {
  const double area2 = area_vector.squaredNorm();
  const Eigen::Vector3d pa = p - a;
  const double wb = area_vector.dot(pa.cross(c - a)), wc = area_vector.dot((b - a).cross(pa));
  const double wa = area2 - wb - wc;
  TrianglePoint best;
  if (area2 > 0 && wa >= 0 && wb >= 0 && wc >= 0) {
    best.weights = Eigen::Vector3d(wa, wb, wc) / area2;
    best.offset = area_vector * (area_vector.dot(pa) / area2);
    best.distance2 = best.offset.squaredNorm();
    best.interior = true;
    return best;
  }
  best.interior = false;
  best.distance2 = -1;
  const Eigen::Vector3d* corner[3] = {&a, &b, &c};
  const double beyond[3] = {wc, wa,
                            wb};  // edge k runs from corner k to corner k + 1; the third weight is negative there
  for (int k = 0; k < 3; ++k) {
    if (area2 > 0 && beyond[k] >= 0) continue;
    const int l = k == 2 ? 0 : k + 1;
    const double t = closest_on_segment(p, *corner[k], *corner[l]);
    const Eigen::Vector3d offset = p - (*corner[k] + t * (*corner[l] - *corner[k]));
    const double distance2 = offset.squaredNorm();
    if (best.distance2 >= 0 && distance2 >= best.distance2) continue;
    best.distance2 = distance2;
    best.offset = offset;
    best.weights.setZero();
    best.weights[k] = 1 - t;
    best.weights[l] = t;
  }
  return best;
}

/// Nearest points of two lines, p + s d and q + t e.
struct LinePair {
  double s, t;
  bool crossing;  ///< not parallel, and both points inside their segments (0 < s, t < 1)
};

/// Nearest points of the lines through two segments. Segments within 1e-3 rad of parallel never cross.
HOUSE_HOST_DEVICE inline LinePair closest_on_lines(const Eigen::Vector3d& p, const Eigen::Vector3d& d,
                                                   const Eigen::Vector3d& q, const Eigen::Vector3d& e) {
  const Eigen::Vector3d w = p - q;
  const double dd = d.squaredNorm(), ee = e.squaredNorm(), de = d.dot(e), dw = d.dot(w), ew = e.dot(w);
  const double determinant = dd * ee - de * de;
  if (!(determinant > 1e-6 * dd * ee)) return {0, 0, false};
  const double s = (de * ew - ee * dw) / determinant, t = (dd * ew - de * dw) / determinant;
  return {s, t, s > 0 && s < 1 && t > 0 && t < 1};
}

/// Distance of two segments squared [m2]; any configuration, parallel and degenerate ones included.
HOUSE_HOST_DEVICE inline double segment_distance2(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                                  const Eigen::Vector3d& q0, const Eigen::Vector3d& q1) {
  const LinePair pair = closest_on_lines(p0, p1 - p0, q0, q1 - q0);
  if (pair.crossing) return (p0 + pair.s * (p1 - p0) - q0 - pair.t * (q1 - q0)).squaredNorm();
  const auto to_segment = [](const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (p - a - closest_on_segment(p, a, b) * (b - a)).squaredNorm();
  };
  const double d0 = to_segment(p0, q0, q1), d1 = to_segment(p1, q0, q1);
  const double d2 = to_segment(q0, p0, p1), d3 = to_segment(q1, p0, p1);
  const double m0 = d0 < d1 ? d0 : d1, m1 = d2 < d3 ? d2 : d3;
  return m0 < m1 ? m0 : m1;
}

}  // namespace qdem
