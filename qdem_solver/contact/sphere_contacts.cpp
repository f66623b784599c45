#include "qdem_solver/contact/sphere_contacts.hpp"

#include <algorithm>
#include <limits>

namespace qdem {

using Eigen::Vector3d;

bool SphereContacts::turning() const {
  const auto rough = [](const Plane& plane) { return plane.friction > 0; };
  return model_.contact.friction > 0 || model_.contact.rolling_friction > 0 ||
         std::any_of(model_.planes.begin(), model_.planes.end(), rough);
}

void SphereContacts::begin(State& state) {
  ContactState& contact = state.contact;
  couples_.resize(contact.keys.size());
  if (model_.contact.rolling_friction > 0) contact.roll.resize(contact.keys.size(), Vector3d::Zero());
  const std::size_t n = skins_.size();
  bodies_.assign(n, {});
  spins_.assign(n, Vector3d::Zero());
  has_couple_.assign(n, 0);
  if (!turning()) return;
  couple_force_.resize(state.x.size());
  std::vector<char> near(n, 0);
  for (const ContactKey& key : contact.keys) {
    near[key.body_a] = 1;
    if (!key.is_plane()) near[key.body_b] = 1;
  }
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t b = 0; b < n; ++b) {
    if (!near[b]) continue;
    bodies_[b].emplace(skins_[b], state.x.data());
    spins_[b] = bodies_[b]->spin(skins_[b], state.x.data(), state.v.data());
  }
}

ContactSphere SphereContacts::sphere(const State& state, int body, int node) const {
  const BodySkin& skin = skins_[body];
  ContactSphere result{skin.at(state.x.data(), node), skin.at(state.v.data(), node), spins_[body], skin.radii[node]};
  if (bodies_[body]) result.rolling_inertia = bodies_[body]->rolling_inertia(result.radius);
  return result;
}

EntryForce SphereContacts::push(const ContactLaw& law, State& state, std::size_t entry, double dt) {
  ContactState& contact = state.contact;
  const ContactKey& key = contact.keys[entry];
  const BodySkin& skin_a = skins_[key.body_a];
  const Plane* plane = key.is_plane() ? &model_.planes[~key.body_b] : nullptr;
  const Vector3d centre = skin_a.at(state.x.data(), key.feature_a);
  const double radius = skin_a.radii[key.feature_a];
  SphereMeeting meeting;
  if (plane != nullptr) {
    meeting = meet(centre, radius, *plane, state.time);
  } else {
    const BodySkin& skin_b = skins_[key.body_b];
    meeting = meet(centre, radius, skin_b.at(state.x.data(), key.feature_b), skin_b.radii[key.feature_b]);
  }
  const bool rolls = law.rolling_friction > 0;
  EntryForce result;
  if (!(meeting.gap < 0)) {
    contact.slip[entry].setZero();
    if (rolls) contact.roll[entry].setZero();
    result.gap = meeting.gap;
    return result;
  }
  const ContactSphere a = sphere(state, key.body_a, key.feature_a);
  ContactSphere b;
  double friction = law.friction, mass = skin_a.mass;
  if (plane != nullptr) {
    b.velocity = plane->velocity, b.spin.setZero(), b.rolling_inertia = std::numeric_limits<double>::infinity();
    friction = plane->friction;
  } else {
    b = sphere(state, key.body_b, key.feature_b);
    mass = reduced_mass(skin_a, skins_[key.body_b]);
  }
  const Vector3d roll = rolls ? contact.roll[entry] : Vector3d(Vector3d::Zero());
  const SphereForce force = push_spheres(law, friction, meeting, mass, a, b, contact.slip[entry], roll, dt);
  contact.slip[entry] = force.slip;
  if (rolls) contact.roll[entry] = force.roll;
  couples_[entry] = {force.couple_a, force.couple_b};
  result.live = true, result.n_a = 1, result.n_b = plane != nullptr ? 0 : 1;
  result.nodes_a[0] = key.feature_a, result.nodes_b[0] = key.feature_b;
  result.force_a[0] = force.force, result.force_b[0] = -force.force;
  result.overlap = -meeting.gap, result.energy = force.energy;
  result.dissipated = force.dissipated;
  return result;
}

void SphereContacts::end(const State& state, const LiveEntries& live) {
  if (!turning()) return;
#pragma omp parallel for schedule(dynamic, 16)
  for (std::size_t b = 0; b < skins_.size(); ++b) {
    const int body = static_cast<int>(b);
    Vector3d couple = Vector3d::Zero();
    for (const std::int64_t i : live.first_of(body)) couple += couples_[i].on_a;
    for (const std::int64_t i : live.second_of(body)) couple += couples_[i].on_b;
    has_couple_[b] = !couple.isZero(0);
    if (!has_couple_[b]) continue;
    const BodySkin& skin = skins_[b];
    for (int i = 0; i < skin.shape->n_nodes(); ++i) {
      const Vector3d share = bodies_[b]->couple_share(skin, state.x.data(), i, couple);
      double* p = &couple_force_[skin.offset + 3 * skin.stride * i];
      p[0] = share[0], p[skin.stride] = share[1], p[2 * skin.stride] = share[2];
    }
  }
}

void SphereContacts::add_couples(int body, proto::Span<double> force) const {
  if (has_couple_.empty() || !has_couple_[body]) return;
  const BodySkin& skin = skins_[body];
  for (int i = 0; i < 3 * skin.shape->n_nodes(); ++i) {
    const std::int64_t at = skin.offset + skin.stride * i;
    force[at] += couple_force_[at];
  }
}

}  // namespace qdem
