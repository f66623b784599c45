#include "qdem_solver/engine/device/tables.hpp"

#include <map>
#include <utility>

#include "qdem_solver/engine/cpu/tasks.hpp"

namespace qdem::device {
namespace {

template <class T>
std::int64_t append(std::vector<T>& values, const T* first, std::size_t n) {
  const auto at = static_cast<std::int64_t>(values.size());
  values.insert(values.end(), first, first + n);
  return at;
}

void cut(std::vector<WorkBlock>& blocks, int batch, int n) {
  for (int first = 0; first < n; first += block_size) blocks.push_back({batch, first});
}

/// Shapes that several batches share are stored once.
class ShapeArrays {
 public:
  ShapeArrays(const Model& model, Tables& tables) : model_(model), tables_(tables) {}

  void fill(BatchRecord& record, const Batch& batch) {
    const Interaction interaction = model_.materials[batch.material_id].interaction;
    const Template& shape = model_.templates[batch.template_id];
    const auto [found, is_new] = elements_.try_emplace({batch.template_id, interaction});
    if (is_new) found->second = add_elements(shape, interaction);
    const BatchRecord& known = found->second;
    record.n_elements = known.n_elements;
    record.particles_at = known.particles_at, record.shapes_at = known.shapes_at;
    record.weights_at = known.weights_at, record.offsets_at = known.offsets_at;
    record.adjacency_at = known.adjacency_at, record.volumes_at = known.volumes_at;
  }

  void fill(BodyRecord& record, int template_id) {
    const Template& shape = model_.templates[template_id];
    const auto [found, is_new] = skins_.try_emplace(template_id);
    if (is_new) {
      BodyRecord& skin = found->second;
      skin.surface_at = append(tables_.surface_nodes, shape.surface_nodes.data(), shape.surface_nodes.size());
      skin.triangles_at = append(tables_.triangles, shape.triangles.data(), shape.triangles.size());
      skin.edges_at = append(tables_.edges, shape.edges.data(), shape.edges.size());
    }
    record.surface_at = found->second.surface_at, record.triangles_at = found->second.triangles_at;
    record.edges_at = found->second.edges_at;
    record.n_surface_nodes = static_cast<int>(shape.surface_nodes.size());
    record.n_triangles = static_cast<int>(shape.triangles.size());
    record.n_edges = static_cast<int>(shape.edges.size());
  }

 private:
  BatchRecord add_elements(const Template& shape, Interaction interaction) {
    const cpu::ElementView view = cpu::view_of(shape, interaction);
    const auto n = static_cast<std::size_t>(view.n_elements);
    const std::size_t n_shape =
        interaction == Interaction::bond ? BondForce<double>::n_shape : QuadrupleForce<double>::n_shape;
    BatchRecord record{};
    record.n_elements = view.n_elements;
    record.particles_at = append(tables_.particles, view.particles, n * view.n_particles);
    record.shapes_at = append(tables_.shapes, view.shapes, n * n_shape);
    record.weights_at = append(tables_.weights, view.weights, n);
    record.offsets_at = append(tables_.offsets, view.adjacency_offsets, shape.nodes.size() + 1);
    record.adjacency_at = append(tables_.adjacency, view.adjacency_slots, n * view.n_particles);
    record.volumes_at = append(tables_.volumes, shape.node_volumes.data(), shape.node_volumes.size());
    return record;
  }

  const Model& model_;
  Tables& tables_;
  std::map<std::pair<int, Interaction>, BatchRecord> elements_;
  std::map<int, BodyRecord> skins_;
};

void add_batch(const Model& model, int number, ShapeArrays& shapes, Tables& tables) {
  const Batch& batch = model.batches[number];
  const Material& material = model.materials[batch.material_id];
  const bool bonded = material.interaction == Interaction::bond;
  BatchRecord record{};
  shapes.fill(record, batch);
  record.lanes = batch.lanes, record.n_nodes = model.templates[batch.template_id].n_nodes();
  record.n_chunks = (record.n_nodes + chunk_size - 1) / chunk_size;
  record.values_at = batch.offset, record.slots_at = tables.n_slots;
  record.rows_at = tables.n_rows, record.chunks_at = tables.n_chunks;
  record.material = cpu::material_of(material), record.density = material.density;
  for (int lane = 0; lane < lane_width; ++lane) {
    record.scale[lane] = batch.scale[lane], record.bodies[lane] = batch.bodies[lane];
  }
  const int n_corners = bonded ? BondForce<double>::n_particles : QuadrupleForce<double>::n_particles;
  tables.n_slots += std::int64_t{3} * n_corners * record.n_elements * batch.lanes;
  tables.n_rows += std::int64_t{record.n_nodes} * batch.lanes;
  tables.n_chunks += std::int64_t{record.n_chunks} * batch.lanes;
  cut(bonded ? tables.bond_blocks : tables.quadruple_blocks, number, record.n_elements * batch.lanes);
  cut(tables.node_blocks, number, record.n_nodes * batch.lanes);
  cut(tables.chunk_blocks, number, record.n_chunks * batch.lanes);
  tables.batches.push_back(record);
}

void add_body(const Model& model, int number, const SkinView& skin, ShapeArrays& shapes, Tables& tables) {
  const Body& body = model.bodies[number];
  BodyRecord record{};
  shapes.fill(record, body.template_id);
  record.values_at = skin.offset, record.row = tables.batches[body.batch].rows_at + body.lane;
  record.lanes = model.stride(number), record.lane = body.lane, record.batch = body.batch;
  record.is_sleeper = body.kind == BodyKind::sleeper;
  record.mass_factor = skin.mass_factor, record.mass = skin.mass;
  tables.surface_rows.push_back(tables.surface_rows.back() + record.n_surface_nodes);
  tables.bodies.push_back(record);
}

}  // namespace

Tables make_tables(const Model& model) {
  Tables tables;
  ShapeArrays shapes(model, tables);
  for (int b = 0; b < static_cast<int>(model.batches.size()); ++b) add_batch(model, b, shapes, tables);
  const auto skins = make_skins(model);
  tables.surface_rows.push_back(0);
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) add_body(model, b, skins[b], shapes, tables);
  tables.inverse_mass = cpu::inverse_masses(model);
  tables.free_motions = cpu::free_motions(model);
  return tables;
}

PadTables make_pad_tables(const Model& model) {
  PadTables tables;
  tables.cell_offsets.push_back(0);
  if (model.pads.empty()) return tables;
  std::vector<std::vector<std::pair<int, double>>> of_node(model.shape(model.pad_body).n_nodes());
  for (std::size_t cell = 0; cell < model.pads.size(); ++cell) {
    const PadCell& pad = model.pads[cell];
    append(tables.axes, pad.axes.data(), 9);
    append(tables.laws, pad.laws.data(), 3);
    append(tables.nodes, pad.nodes.data(), pad.nodes.size());
    append(tables.weights, pad.weights.data(), pad.weights.size());
    tables.cell_offsets.push_back(static_cast<int>(tables.nodes.size()));
    for (std::size_t i = 0; i < pad.nodes.size(); ++i) {
      of_node[pad.nodes[i]].emplace_back(static_cast<int>(cell), pad.weights[i]);
    }
  }
  tables.node_offsets.push_back(0);
  for (const auto& cells : of_node) {
    for (const auto& [cell, weight] : cells) tables.cells.push_back(cell), tables.cell_weights.push_back(weight);
    tables.node_offsets.push_back(static_cast<int>(tables.cells.size()));
  }
  return tables;
}

std::vector<PlaneRecord> make_plane_records(const Model& model) {
  std::vector<PlaneRecord> records;
  for (const Plane& plane : model.planes) {
    PlaneRecord record{};
    for (int c = 0; c < 3; ++c) {
      record.point[c] = plane.point[c], record.normal[c] = plane.normal[c], record.velocity[c] = plane.velocity[c];
    }
    record.friction = plane.friction;
    record.touches_stones = plane.touches_stones, record.touches_sleeper = plane.touches_sleeper;
    records.push_back(record);
  }
  return records;
}

Loads make_loads(const Model& model) {
  Loads loads{};
  for (int c = 0; c < 3; ++c) loads.gravity[c] = model.gravity[c];
  loads.local_damping = model.inertia.empty() ? model.local_damping : 0.0;
  loads.drag = model.drag_per_s;
  if (model.pad_body < 0) return loads;
  for (int c = 0; c < 3; ++c) {
    loads.load_density[c] = model.pad_body_load[c] / model.shape(model.pad_body).volume();
  }
  return loads;
}

}  // namespace qdem::device
