#include "qdem_solver/contact/contact_rates.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "qdem_solver/contact/edge_pair.hpp"
#include "qdem_solver/contact/surface_point.hpp"

namespace qdem {

using Eigen::Matrix3d, Eigen::Vector3d;

namespace {

/// Largest stiffness of one contact point [N/m]. Half as much again: the force of an edge pair changes with its share
/// too (edge_pair.hpp).
double largest_stiffness(const ContactLaw& law) {
  return 1.5 * law.normal_stiffness * std::max(1.0, law.tangential_ratio);
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
      rates_(skins.size()) {
  for (int b = 0; b < static_cast<int>(skins.size()); ++b) {
    const BodySkin& skin = skins[b];
    RigidBody body{Vector3d::Zero(), 1 / model.body_mass(b), Matrix3d::Zero()};
    for (int i = 0; i < skin.shape->n_nodes(); ++i) {
      body.centre += skin.node_mass(i) / model.body_mass(b) * skin.at(state.x.data(), i);
    }
    Matrix3d moment = Matrix3d::Zero();
    for (int i = 0; i < skin.shape->n_nodes(); ++i) {
      const Vector3d arm = skin.at(state.x.data(), i) - body.centre;
      moment += skin.node_mass(i) * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
    }
    body.inverse_inertia = moment.inverse();
    bodies_.push_back(body);
  }
}

double ContactRateSums::RigidBody::mobility(const Vector3d& point) const {
  const Vector3d r = point - centre;
  Matrix3d cross;
  cross << 0, -r[2], r[1], r[2], 0, -r[0], -r[1], r[0], 0;
  return inverse_mass + (cross * inverse_inertia * cross.transpose()).norm();
}

void ContactRateSums::add_share(const Share& share, const Vector3d& point, double stiffness, double damping) {
  const BodySkin& skin = skins_[share.body];
  for (int i = 0; i < share.n; ++i) {
    const double per_mass = share.weights[i] / skin.node_mass(share.nodes[i]);
    Rates& row = particles_[skin.offset + 3 * skin.stride * share.nodes[i]];
    row = row + Rates{stiffness * per_mass, damping * per_mass};
  }
  const double mobility = bodies_[share.body].mobility(point);
  rates_[share.body].rigid = rates_[share.body].rigid + Rates{stiffness * mobility, damping * mobility};
}

std::optional<ContactRateSums::Approach> ContactRateSums::approach(std::size_t entry) const {
  const ContactState& contact = state_.contact;
  const ContactKey& key = contact.keys[entry];
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
  add_share(near->share, near->point, sides * stiffness, sides * dashpot);
  if (near->other) add_share(*near->other, near->point, sides * stiffness, sides * dashpot);
}

std::vector<ContactRates> ContactRateSums::result() const {
  std::vector<ContactRates> rates = rates_;
  for (std::size_t b = 0; b < skins_.size(); ++b) {
    const BodySkin& skin = skins_[b];
    for (const int node : skin.shape->surface_nodes) {
      rates[b].particle = larger(rates[b].particle, particles_[skin.offset + 3 * skin.stride * node]);
    }
  }
  return rates;
}

}  // namespace qdem
