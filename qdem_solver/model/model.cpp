#include "qdem_solver/model/model.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "qdem_solver/model/bond_network.hpp"

namespace qdem {
namespace {

/// So few bodies are integrated faster one by one than as lanes of a batch that is mostly spare.
constexpr std::size_t smallest_lane_group = 3;

void add_batch(Model& model, const int* bodies, int n_bodies, int lanes) {
  const Body& first = model.bodies[bodies[0]];
  Batch batch;
  batch.template_id = first.template_id, batch.material_id = first.material_id;
  batch.lanes = lanes;
  batch.offset = model.n_values;
  batch.bodies.fill(-1);
  batch.scale.fill(first.scale);
  for (int lane = 0; lane < n_bodies; ++lane) {
    Body& body = model.bodies[bodies[lane]];
    body.batch = static_cast<int>(model.batches.size()), body.lane = lane;
    batch.bodies[lane] = bodies[lane], batch.scale[lane] = body.scale;
  }
  model.n_values += std::int64_t{3} * model.templates[batch.template_id].n_nodes() * lanes;
  // Whole groups of eight values: threads that own neighbouring batches then hardly share a cache line.
  model.n_values = (model.n_values + lane_width - 1) / lane_width * lane_width;
  model.batches.push_back(batch);
}

void make_missing_bonds(Model& model) {
  for (const Body& body : model.bodies) {
    Template& shape = model.templates[body.template_id];
    if (shape.bonds || model.materials[body.material_id].interaction != Interaction::bond) continue;
    shape.bonds = std::make_shared<const BondNetwork>(make_bond_network(shape));
  }
}

}  // namespace

double Model::node_mass(int body, int node) const {
  const double scale = bodies[body].scale;
  return material(body).density * scale * scale * scale * shape(body).node_volumes[node];
}

double Model::body_mass(int body) const {
  const double scale = bodies[body].scale;
  return material(body).density * scale * scale * scale * shape(body).volume();
}

Eigen::Vector3d Model::gravity_on(int body) const {
  return bodies[body].kind == BodyKind::ground ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : gravity;
}

std::int64_t Model::n_elements() const {
  std::int64_t sum = 0;
  for (int body = 0; body < static_cast<int>(bodies.size()); ++body) sum += shape(body).n_tets();
  return sum;
}

void make_batches(Model& model) {
  model.batches.clear();
  model.n_values = 0;
  std::map<std::pair<int, int>, std::vector<int>> groups;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    groups[{model.bodies[b].template_id, model.bodies[b].material_id}].push_back(b);
  }
  for (const auto& [key, bodies] : groups) {
    std::size_t i = 0;
    while (bodies.size() - i >= smallest_lane_group) {
      const auto n = std::min<std::size_t>(lane_width, bodies.size() - i);
      add_batch(model, &bodies[i], static_cast<int>(n), lane_width);
      i += n;
    }
    for (; i < bodies.size(); ++i) add_batch(model, &bodies[i], 1, 1);
  }
  make_missing_bonds(model);
}

}  // namespace qdem
