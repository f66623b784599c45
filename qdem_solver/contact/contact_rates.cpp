#include "qdem_solver/contact/contact_rates.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "qdem_solver/contact/edge_pair.hpp"
#include "qdem_solver/contact/sphere_pair.hpp"
#include "qdem_solver/contact/surface_point.hpp"

namespace qdem {

using Eigen::Matrix3d, Eigen::Vector3d;

namespace {

/// Largest stiffness of one contact point [N/m]. The force of an edge pair changes with its share too (edge_pair.hpp):
/// half as much again.
double largest_stiffness(const ContactLaw& law) {
  const double allowance = law.shape == ContactShape::facet ? 1.5 : 1.0;
  return allowance * law.normal_stiffness * std::max(1.0, law.tangential_ratio);
}

Rates operator*(double factor, const Rates& rates) {
  return {factor * rates.stiffness, factor * rates.damping};
}

}  // namespace

ContactRateSums::ContactRateSums(const Model& model, const std::vector<BodySkin>& skins, const EntryLaws& laws,
                                 const State& state, double gap)
    : skins_(skins),
      state_(state),
      model_(model),
      laws_(laws),
      gap_(gap),
      particles_(state.x.size()),
      turning_(skins.size()),
      rates_(skins.size()) {
  for (const BodySkin& skin : skins) bodies_.emplace_back(skin, state.x.data());
}

void ContactRateSums::add_share(const Share& share, const Vector3d& point, const Rates& contact) {
  const BodySkin& skin = skins_[share.body];
  const RigidBody& body = bodies_[share.body];
  const double turned = share.arm * share.arm * body.inverse_inertia.norm();
  double along = 1.0;  // 1 + s
  if (turned > 0) {
    const double s = std::sqrt(turned * skin.node_mass(share.nodes[0]));
    along += s;
    turning_[share.body] = turning_[share.body] + (1 + 1 / s) * turned * contact;
  }
  for (int i = 0; i < share.n; ++i) {
    const double per_mass = along * share.weights[i] / skin.node_mass(share.nodes[i]);
    Rates& row = particles_[skin.offset + 3 * skin.stride * share.nodes[i]];
    row = row + per_mass * contact;
  }
  rates_[share.body].rigid = rates_[share.body].rigid + body.mobility(point) * contact;
}

std::optional<ContactRateSums::Approach> ContactRateSums::approach_of_spheres(const ContactKey& key) const {
  const double* x = state_.x.data();
  const BodySkin& a = skins_[key.body_a];
  const Vector3d centre = a.at(x, key.feature_a);
  const double radius = a.radii[key.feature_a];
  Share share{key.body_a, 1, {key.feature_a}, {1.0}};
  const double inertia = bodies_[key.body_a].rolling_inertia(radius);
  if (key.is_plane()) {
    const Plane& plane = model_.planes[~key.body_b];
    const SphereMeeting meeting = meet(centre, radius, plane, state_.time);
    if (meeting.gap > gap_) return {};
    if (plane.friction > 0) share.arm = radius;
    return Approach{centre - radius * meeting.normal, share, {}, meeting.rolling_radius, inertia};
  }
  const BodySkin& b = skins_[key.body_b];
  const double other_radius = b.radii[key.feature_b];
  const SphereMeeting meeting = meet(centre, radius, b.at(x, key.feature_b), other_radius);
  if (meeting.gap > gap_) return {};
  Share other{key.body_b, 1, {key.feature_b}, {1.0}};
  if (model_.contact.friction > 0) share.arm = radius, other.arm = other_radius;
  return Approach{centre - radius * meeting.normal, share, other, meeting.rolling_radius,
                  joint_inertia(inertia, bodies_[key.body_b].rolling_inertia(other_radius))};
}

std::optional<ContactRateSums::Approach> ContactRateSums::approach(std::size_t entry) const {
  const ContactState& contact = state_.contact;
  const ContactKey& key = contact.keys[entry];
  if (model_.contact.shape == ContactShape::sphere) return approach_of_spheres(key);
  const double* x = state_.x.data();
  const double rounding = model_.contact.rounding;
  const BodySkin& a = skins_[key.body_a];
  const Share node{key.body_a, 1, {key.feature_a}, {1.0}};
  if (key.is_plane()) {
    const Plane& plane = model_.planes[~key.body_b];
    const Vector3d point = a.at(x, key.feature_a);
    const double height = plane.normal.dot(point - plane.point - state_.time * plane.velocity);
    return height - rounding > gap_ ? std::optional<Approach>() : Approach{point, node, {}};
  }
  const BodySkin& b = skins_[key.body_b];
  if (key.is_edge_pair()) {
    // Edges that would not touch with surfaces rounded by the gap more have no force, or one that grows from zero.
    const EdgeContact touch = touch_edges(a, key.feature_a, b, key.feature_b, x, 2 * rounding + gap_);
    if (!touch.touching) return {};
    const auto &na = a.shape->edges[key.feature_a].nodes, &nb = b.shape->edges[key.feature_b].nodes;
    return Approach{EdgeNow(a, x, key.feature_a).at(touch.s),
                    {key.body_a, 2, {na[0], na[1]}, {1 - touch.s, touch.s}},
                    Share{key.body_b, 2, {nb[0], nb[1]}, {1 - touch.t, touch.t}}};
  }
  const Vector3d point = a.at(x, key.feature_a);
  const SurfacePoint nearest =
      nearest_surface_point(b, x, point, contact.triangles.data() + contact.triangle_offsets[entry],
                            contact.triangles.data() + contact.triangle_offsets[entry + 1]);
  if (nearest.distance - 2 * rounding > gap_) return {};
  const auto& w = nearest.weights;
  const Share facet{key.body_b, 3, b.shape->triangles[nearest.triangle].nodes, {w[0], w[1], w[2]}};
  return Approach{point, node, facet};
}

void ContactRateSums::add_rolling(const Share& share, const Rates& couple) {
  const Rates turning = bodies_[share.body].inverse_inertia.norm() * couple;
  turning_[share.body] = turning_[share.body] + turning;
  rates_[share.body].rigid = rates_[share.body].rigid + turning;
}

void ContactRateSums::add(std::size_t entry) {
  const auto near = approach(entry);
  if (!near) return;
  const double sides = near->other ? 2 : 1;
  const BodySkin& a = skins_[near->share.body];
  const double mass = near->other ? reduced_mass(a, skins_[near->other->body]) : a.mass;
  const ContactLaw& law = laws_.of(state_.contact, entry);
  const double stiffness = largest_stiffness(law);
  const double dashpot =
      2 * law.damping_ratio * std::sqrt(stiffness * mass) + std::max(law.normal_damping, law.tangential_damping);
  const Rates contact{sides * stiffness, sides * dashpot};
  add_share(near->share, near->point, contact);
  if (near->other) add_share(*near->other, near->point, contact);
  if (!(near->rolling_radius > 0)) return;
  const RollingLaw rolling(law);
  const Rates couple = sides * Rates{rolling.stiffness(near->rolling_radius),
                                     rolling.dashpot(near->rolling_radius, near->rolling_inertia)};
  add_rolling(near->share, couple);
  if (near->other) add_rolling(*near->other, couple);
}

std::vector<ContactRates> ContactRateSums::result() const {
  std::vector<ContactRates> rates = rates_;
  for (std::size_t b = 0; b < skins_.size(); ++b) {
    const BodySkin& skin = skins_[b];
    for (const int node : skin.shape->surface_nodes) {
      rates[b].particle = larger(rates[b].particle, particles_[skin.offset + 3 * skin.stride * node]);
    }
    rates[b].particle = rates[b].particle + turning_[b];
  }
  return rates;
}

}  // namespace qdem
