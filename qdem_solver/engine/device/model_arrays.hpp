// The immutable model in device memory.
#pragma once

#include "qdem_solver/engine/device/buffer.hpp"
#include "qdem_solver/engine/device/tables.hpp"

namespace qdem::device {

template <class Backend>
class ModelArrays {
 public:
  explicit ModelArrays(const Model& model)
      : tables_(make_tables(model)),
        batches_(tables_.batches),
        bodies_(tables_.bodies),
        particles_(tables_.particles),
        offsets_(tables_.offsets),
        adjacency_(tables_.adjacency),
        surface_nodes_(tables_.surface_nodes),
        shapes_(tables_.shapes),
        weights_(tables_.weights),
        volumes_(tables_.volumes),
        triangles_(tables_.triangles),
        edges_(tables_.edges),
        inverse_mass_(tables_.inverse_mass),
        free_motions_(tables_.free_motions),
        quadruple_blocks_(tables_.quadruple_blocks),
        bond_blocks_(tables_.bond_blocks),
        node_blocks_(tables_.node_blocks),
        chunk_blocks_(tables_.chunk_blocks) {}

  ModelView view() const {
    return {batches_.data(),      bodies_.data(),
            particles_.data(),    offsets_.data(),
            adjacency_.data(),    surface_nodes_.data(),
            shapes_.data(),       weights_.data(),
            volumes_.data(),      triangles_.data(),
            edges_.data(),        inverse_mass_.data(),
            free_motions_.data(), quadruple_blocks_.data(),
            bond_blocks_.data(),  node_blocks_.data(),
            chunk_blocks_.data(), static_cast<int>(tables_.bodies.size())};
  }
  const Tables& tables() const { return tables_; }

  std::int64_t n_quadruple_items() const { return items(tables_.quadruple_blocks); }
  std::int64_t n_bond_items() const { return items(tables_.bond_blocks); }
  std::int64_t n_node_items() const { return items(tables_.node_blocks); }
  std::int64_t n_chunk_items() const { return items(tables_.chunk_blocks); }

 private:
  template <class T>
  using Array = Buffer<Backend, T>;

  static std::int64_t items(const std::vector<WorkBlock>& blocks) {
    return static_cast<std::int64_t>(blocks.size()) * block_size;
  }

  Tables tables_;
  Array<BatchRecord> batches_;
  Array<BodyRecord> bodies_;
  Array<int> particles_, offsets_, adjacency_, surface_nodes_;
  Array<double> shapes_, weights_, volumes_;
  Array<Triangle> triangles_;
  Array<Edge> edges_;
  Array<double> inverse_mass_, free_motions_;
  Array<WorkBlock> quadruple_blocks_, bond_blocks_, node_blocks_, chunk_blocks_;
};

}  // namespace qdem::device
