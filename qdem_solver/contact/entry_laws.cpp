#include "qdem_solver/contact/entry_laws.hpp"

#include <algorithm>
#include <cmath>

namespace qdem {
namespace {

constexpr double same_level = 1e-9;  ///< of the bottom's particles [template lengths]

struct Voigt {
  double stiffness, damping;
};

Voigt in_series(const Voigt& p, const Voigt& q) {
  const double sum = p.stiffness + q.stiffness;
  if (!(sum > 0)) return {0.0, 0.0};
  return {p.stiffness * q.stiffness / sum,
          p.damping * std::pow(q.stiffness / sum, 2) + q.damping * std::pow(p.stiffness / sum, 2)};
}

}  // namespace

Bearing in_series(const Bearing& p, const Bearing& q) {
  if (p.is_rigid()) return q;
  if (q.is_rigid()) return p;
  const Voigt normal = in_series(Voigt{p.normal_stiffness, p.normal_damping}, {q.normal_stiffness, q.normal_damping});
  const Voigt tangential =
      in_series(Voigt{p.tangential_stiffness, p.tangential_damping}, {q.tangential_stiffness, q.tangential_damping});
  return {normal.stiffness, tangential.stiffness, normal.damping, tangential.damping, p.footprint};
}

Bearing half_space(const Material& ground, double radius) {
  const double stiffness = ground.mu() * radius, damping = radius * radius * std::sqrt(ground.density * ground.mu());
  const double vertical = 1 - ground.poisson, horizontal = 2 - ground.poisson;
  return {4 * stiffness / vertical, 8 * stiffness / horizontal, 3.4 * damping / vertical, 4.6 * damping / horizontal,
          M_PI * radius * radius};
}

ContactLaw in_series(const ContactLaw& law, const Bearing& bearing) {
  if (bearing.is_rigid()) return law;
  const double kt = law.normal_stiffness * law.tangential_ratio;
  const Voigt normal =
      in_series(Voigt{law.normal_stiffness, law.normal_damping}, {bearing.normal_stiffness, bearing.normal_damping});
  const Voigt tangential =
      in_series(Voigt{kt, law.tangential_damping}, {bearing.tangential_stiffness, bearing.tangential_damping});
  ContactLaw result = law;
  result.normal_stiffness = normal.stiffness, result.normal_damping = normal.damping;
  result.tangential_ratio = tangential.stiffness / normal.stiffness, result.tangential_damping = tangential.damping;
  result.damping_ratio *= std::pow(normal.stiffness / law.normal_stiffness, 1.5);
  return result;
}

EntryLaws::EntryLaws(const Model& model) : model_(model) {
  for (const Body& body : model.bodies) has_ground_ = has_ground_ || body.kind == BodyKind::ground;
  if (model.pad_body >= 0) {
    const Template& shape = model.shape(model.pad_body);
    double low = shape.nodes.front()[2];
    for (const auto& node : shape.nodes) low = std::min(low, node[2]);
    for (const auto& node : shape.nodes) nodes_.push_back(node[2] <= low + same_level);
    const auto lined = [&](int node) { return nodes_[node] != 0; };
    for (const Triangle& t : shape.triangles) {
      triangles_.push_back(std::all_of(t.nodes.begin(), t.nodes.end(), lined));
    }
    for (const Edge& e : shape.edges) edges_.push_back(std::all_of(e.nodes.begin(), e.nodes.end(), lined));
  }
  refresh();
}

void EntryLaws::refresh() {
  lined_ = in_series(model_.contact, model_.lining);
  of_ground_ = {model_.contact, lined_};
  for (ContactLaw& law : of_ground_) law.friction = model_.ground_friction;
  of_plane_.clear();
  for (const Plane& plane : model_.planes) {
    of_plane_.push_back({in_series(model_.contact, plane.bearing), in_series(lined_, plane.bearing)});
  }
}

bool EntryLaws::is_lined(const ContactState& contact, std::size_t entry) const {
  if (model_.lining.is_rigid()) return false;
  const ContactKey& key = contact.keys[entry];
  if (model_.contact.shape == ContactShape::sphere) {
    if (key.body_a == model_.pad_body) return nodes_[key.feature_a] != 0;
    return !key.is_plane() && key.body_b == model_.pad_body && nodes_[key.feature_b] != 0;
  }
  if (key.body_a == model_.pad_body) return (key.is_edge_pair() ? edges_ : nodes_)[key.feature_a] != 0;
  if (key.is_plane() || key.body_b != model_.pad_body) return false;
  if (key.is_edge_pair()) return edges_[key.feature_b] != 0;
  const int* first = contact.triangles.data() + contact.triangle_offsets[entry];
  const int* last = contact.triangles.data() + contact.triangle_offsets[entry + 1];
  return std::any_of(first, last, [&](int triangle) { return triangles_[triangle] != 0; });
}

bool EntryLaws::touches_ground(const ContactKey& key) const {
  const auto is_ground = [&](int body) { return model_.bodies[body].kind == BodyKind::ground; };
  return has_ground_ && (is_ground(key.body_a) || is_ground(key.body_b));
}

const ContactLaw& EntryLaws::of(const ContactState& contact, std::size_t entry) const {
  const bool lined = is_lined(contact, entry);
  const ContactKey& key = contact.keys[entry];
  if (key.is_plane()) return of_plane_[~key.body_b][lined ? 1 : 0];
  if (touches_ground(key)) return of_ground_[lined ? 1 : 0];
  return lined ? lined_ : model_.contact;
}

}  // namespace qdem
