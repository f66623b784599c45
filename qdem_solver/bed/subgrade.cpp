#include "qdem_solver/bed/subgrade.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "qdem_solver/bed/sleeper_shape.hpp"

namespace qdem {
namespace {

using Eigen::Vector3d;

constexpr int ground_plane = 0;

const Plane& plane_named(const Model& model, const std::string& name) {
  return *std::find_if(model.planes.begin(), model.planes.end(),
                       [&](const Plane& plane) { return plane.name == name; });
}

/// Values of a state with one body more at its end, which is at rest.
State with_last_body(const Model& model, const State& old, const Placement& place) {
  std::vector<Placement> places(model.bodies.size());
  places.back() = place;
  State state = make_state(model, places);
  const std::pair<const std::vector<double>*, std::vector<double>*> parts[] = {
      {&old.x, &state.x}, {&old.v, &state.v}, {&old.a, &state.a}};
  for (const auto& [from, to] : parts) std::copy(from->begin(), from->end(), to->begin());
  state.step = old.step, state.time = old.time;
  state.contact = old.contact;
  return state;
}

/// Contacts on the plane become contacts on the body and keep their slip. The next list is a new one.
void hand_over(ContactState& contact, int body) {
  std::vector<std::pair<ContactKey, Vector3d>> entries;
  for (std::size_t i = 0; i < contact.keys.size(); ++i) {
    ContactKey key = contact.keys[i];
    if (key.body_b == ~ground_plane) key.body_b = body;
    entries.emplace_back(key, contact.slip[i]);
  }
  std::sort(entries.begin(), entries.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
  const double rebuild_time = contact.rebuild_time;
  const auto rebuilds = contact.rebuilds;
  contact = ContactState{};
  contact.rebuild_time = rebuild_time, contact.rebuilds = rebuilds;
  for (const auto& [key, slip] : entries) contact.keys.push_back(key), contact.slip.push_back(slip);
  contact.triangle_offsets.assign(contact.keys.size() + 1, 0);
}

void hold_symmetry_planes(Model& model, int body, double half_length) {
  const Template& shape = model.shape(body);
  const double near = 1e-9;
  for (int i = 0; i < shape.n_nodes(); ++i) {
    const Vector3d& x = shape.nodes[i];
    const unsigned mask = (std::abs(x[0]) > half_length - near ? 1u : 0u) | (x[1] < near ? 2u : 0u);
    if (mask != 0) model.fixities.push_back({body, i, mask});
  }
}

}  // namespace

std::string too_coarse(const SubgradeLayer& layer) {
  const double resolved = layer.resolved_frequency();
  if (!(layer.highest_frequency > resolved)) return {};
  return fmt::format(
      "the subgrade's elements are too coarse: {:.3g} m resolve {:.3g} Hz, ten on a shear wave, and {:.3g} Hz want "
      "{:.3g} m - [qdem.subgrade] element_m",
      layer.element, resolved, layer.highest_frequency, layer.element * resolved / layer.highest_frequency);
}

namespace bed {

double lay_subgrade(Model& model, State& state, const SubgradeLayer& layer) {
  Plane& ground = model.planes[ground_plane];
  const double level = ground.point[2];
  const double begin = plane_named(model, "bay_begin").point[0], end = plane_named(model, "bay_end").point[0];
  const double half = (end - begin) / 2;

  Body body;
  body.kind = BodyKind::ground, body.name = "subgrade";
  body.template_id = static_cast<int>(model.templates.size());
  body.material_id = static_cast<int>(model.materials.size());
  const int number = static_cast<int>(model.bodies.size());
  model.templates.push_back(box_shape("subgrade", {-half, 0, -layer.thickness}, {half, layer.width, 0}, layer.element));
  model.materials.push_back(layer.material);
  model.bodies.push_back(body);
  make_batches(model);
  hold_symmetry_planes(model, number, half);

  // A particle touches a plane at one rounding, a surface at two.
  Placement place;
  place.translation = {(begin + end) / 2, 0, level - model.contact.rounding};
  state = with_last_body(model, state, place);
  hand_over(state.contact, number);
  model.ground_friction = ground.friction;
  FarField far;
  far.source = place.translation;
  far.normal_stiffness = layer.normal_stiffness, far.tangential_stiffness = layer.tangential_stiffness;
  model.boundary = absorbing_boundary(model, state, number, {{2, -1}, {1, 1}}, far);
  ground.point[2] -= layer.thickness + model.contact.rounding;
  return level;
}

}  // namespace bed
}  // namespace qdem
