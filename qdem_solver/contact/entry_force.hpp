// Forces of one candidate contact of facets on the nodes it involves: node against skin, edge against edge, node
// against plane.
#pragma once

#include "qdem_solver/contact/contact_law.hpp"
#include "qdem_solver/contact/edge_pair.hpp"
#include "qdem_solver/contact/surface_point.hpp"

namespace qdem {

/// What one candidate does to its nodes. Sums of forces and moments over all its nodes vanish to round-off, planes
/// apart.
struct EntryForce {
  bool live = false;     ///< carries a force
  int n_a = 0, n_b = 0;  ///< nodes of body a and of body b
  std::array<int, 2> nodes_a{};
  std::array<int, 3> nodes_b{};
  std::array<Eigen::Vector3d, 2> force_a;
  std::array<Eigen::Vector3d, 3> force_b;
  double overlap = 0.0;  ///< [m]
  double energy = 0.0;   ///< of its springs [J]
  ContactPower dissipated;
  double gap = 0.0;  ///< while it does not touch: no force before the features came nearer by this [m]
};

/// Positions and velocities the kernels read.
struct Motion {
  const double* x;
  const double* v;
  double dt;  ///< [s]
};

namespace detail {

HOUSE_HOST_DEVICE inline std::array<Eigen::Vector3d, 3> corner_velocities(const SkinView& skin, const double* v,
                                                                          const std::array<int, 3>& nodes) {
  return {skin.at(v, nodes[0]), skin.at(v, nodes[1]), skin.at(v, nodes[2])};
}

}  // namespace detail

/// Node of a against the skin of b over candidate triangles [first, last). The normal force acts along the line of the
/// node and its nearest point; the tangential force at the node, to which the triangle is extended as a rigid frame.
HOUSE_HOST_DEVICE inline EntryForce push_node(const ContactLaw& law, const SkinView& a, int node, const SkinView& b,
                                              const int* first, const int* last, const Motion& motion,
                                              Eigen::Vector3d& slip) {
  EntryForce result;
  const Eigen::Vector3d p = a.at(motion.x, node);
  const SurfacePoint point = nearest_surface_point(b, motion.x, p, first, last);
  const double overlap = 2 * law.rounding - point.distance;
  if (point.triangle < 0 || !(overlap > 0)) {
    slip.setZero();
    result.gap = point.triangle < 0 ? 1.0 : -overlap;
    return result;
  }
  const auto& corners = b.triangles[point.triangle].nodes;
  const TriangleFrame frame(TriangleNow(b, motion.x, point.triangle), p);
  const auto vb = detail::corner_velocities(b, motion.v, corners);
  const Eigen::Vector3d va = a.at(motion.v, node);
  Eigen::Vector3d vp = va;
  for (int k = 0; k < 3; ++k) vp -= point.weights[k] * vb[k];
  Touch touch;
  touch.normal = point.normal, touch.overlap = overlap, touch.effective_mass = reduced_mass(a, b);
  touch.normal_velocity = point.normal.dot(vp);
  touch.relative_velocity = va - frame.velocity(vb);
  const TouchForce force = VoigtCoulombLaw(law, law.friction).push(touch, slip, motion.dt);
  slip = force.slip;
  result.live = true, result.n_a = 1, result.n_b = 3;
  result.nodes_a[0] = node, result.nodes_b = corners;
  const Eigen::Vector3d normal_force = force.normal * point.normal;
  result.force_a[0] = normal_force + force.tangential;
  for (int k = 0; k < 3; ++k) {
    result.force_b[k] = -point.weights[k] * normal_force - frame.corner_force(k, force.tangential);
  }
  result.overlap = overlap;
  result.energy = spring_energy(law, overlap, 1.0, slip);
  result.dissipated = force.dissipated;
  return result;
}

/// Edge of a against edge of b. The tangential force acts at the point of a; b's side goes to its first adjacent
/// triangle, extended as a rigid frame.
HOUSE_HOST_DEVICE inline EntryForce push_edges(const ContactLaw& law, const SkinView& a, int edge_a, const SkinView& b,
                                               int edge_b, const Motion& motion, Eigen::Vector3d& slip) {
  EntryForce result;
  const double reach = 2 * law.rounding;
  const EdgeContact contact = touch_edges(a, edge_a, b, edge_b, motion.x, reach);
  if (!contact.touching) {
    slip.setZero();
    result.gap = contact.gap;
    return result;
  }
  const auto& ends_a = a.edges[edge_a].nodes;
  const auto& ends_b = b.edges[edge_b].nodes;
  const int face = b.edges[edge_b].triangles[0];
  const auto& corners = b.triangles[face].nodes;
  const double wa[2] = {1 - contact.s, contact.s};
  std::array<double, 3> wb{};
  for (int k = 0; k < 3; ++k) {
    wb[k] = corners[k] == ends_b[0] ? 1 - contact.t : (corners[k] == ends_b[1] ? contact.t : 0.0);
  }
  const Eigen::Vector3d pa = EdgeNow(a, motion.x, edge_a).at(contact.s);
  const TriangleFrame frame(TriangleNow(b, motion.x, face), pa);
  const auto vb = detail::corner_velocities(b, motion.v, corners);
  const Eigen::Vector3d va = wa[0] * a.at(motion.v, ends_a[0]) + wa[1] * a.at(motion.v, ends_a[1]);
  Eigen::Vector3d vp = va;
  for (int k = 0; k < 3; ++k) vp -= wb[k] * vb[k];

  Touch touch;
  // Edges that passed each other: the line to an end no longer shows the way out, so the share acts on the normal
  // force.
  const bool inside = contact.overlap > reach;
  touch.normal = contact.normal;
  touch.overlap = (inside ? contact.share() : contact.facing) * contact.overlap;
  touch.effective_mass = reduced_mass(a, b), touch.share = contact.share();
  touch.normal_velocity = contact.normal.dot(vp);
  touch.relative_velocity = va - frame.velocity(vb);
  const TouchForce force = VoigtCoulombLaw(law, law.friction).push(touch, slip, motion.dt);
  slip = force.slip;
  const Eigen::Vector3d normal_force = force.normal * contact.normal;
  result.live = true, result.n_a = 2, result.n_b = 3;
  result.nodes_a = ends_a, result.nodes_b = corners;
  for (int k = 0; k < 2; ++k) result.force_a[k] = wa[k] * (normal_force + force.tangential);
  for (int k = 0; k < 3; ++k) {
    result.force_b[k] = -wb[k] * normal_force - frame.corner_force(k, force.tangential);
  }
  result.overlap = contact.overlap;
  result.dissipated = force.dissipated;
  const double r = contact.end.side < 0 ? 0.0 : contact.end.overlap;
  result.energy = 0.5 * law.normal_stiffness *
                  (contact.facing * (contact.overlap * contact.overlap - r * r) +
                   law.tangential_ratio * touch.share * slip.squaredNorm());
  if (contact.end.side < 0 || inside) return result;
  // Take back what the end carries as a node; no more of it than the law left of the spring's force.
  const double spring = law.normal_stiffness * touch.overlap;
  const double left = std::min(1.0, force.normal / spring);
  const double taken = law.normal_stiffness * contact.facing * r * left;
  const Eigen::Vector3d back = -taken * contact.end.normal;
  Eigen::Vector3d parting = Eigen::Vector3d::Zero();  // relative velocity at the end
  const double u = contact.end.parameter;
  for (int k = 0; k < 2; ++k) {
    const double weight = contact.end.side == 0 ? (k == contact.end.end ? 1.0 : 0.0) : (k == 0 ? 1 - u : u);
    result.force_a[k] += weight * back;
    parting += weight * a.at(motion.v, ends_a[k]);
  }
  for (int k = 0; k < 3; ++k) {
    double weight = 0.0;
    for (int e = 0; e < 2; ++e) {
      if (corners[k] != ends_b[e]) continue;
      weight = contact.end.side == 1 ? (e == contact.end.end ? 1.0 : 0.0) : (e == 0 ? 1 - u : u);
    }
    result.force_b[k] -= weight * back;
    parting -= weight * vb[k];
  }
  const double kept = law.normal_stiffness * contact.facing * r - taken;
  result.dissipated.dashpot -= kept * contact.end.normal.dot(parting);
  return result;
}

/// Node against a plane at its place of `time`. `AnyPlane` is a Plane, or its numbers on a device.
template <class AnyPlane>
HOUSE_HOST_DEVICE inline EntryForce push_on_plane(const ContactLaw& law, const SkinView& a, int node,
                                                  const AnyPlane& plane, double time, const Motion& motion,
                                                  Eigen::Vector3d& slip) {
  EntryForce result;
  const Eigen::Vector3d n = plane.normal;
  const double distance = n.dot(a.at(motion.x, node) - plane.point - time * plane.velocity);
  const double overlap = law.rounding - distance;
  if (!(overlap > 0)) {
    slip.setZero();
    result.gap = -overlap;
    return result;
  }
  Touch touch;
  touch.normal = n, touch.overlap = overlap, touch.effective_mass = a.mass;
  touch.relative_velocity = a.at(motion.v, node) - plane.velocity;
  touch.normal_velocity = n.dot(touch.relative_velocity);
  const TouchForce force = VoigtCoulombLaw(law, plane.friction).push(touch, slip, motion.dt);
  slip = force.slip;
  result.live = true, result.n_a = 1, result.n_b = 0;
  result.nodes_a[0] = node;
  result.force_a[0] = force.normal * n + force.tangential;
  result.overlap = overlap;
  result.energy = spring_energy(law, overlap, 1.0, slip);
  result.dissipated = force.dissipated;
  return result;
}

}  // namespace qdem
