// A model taken apart into the arrays that kernels read, still in host memory.
#pragma once

#include <vector>

#include "qdem_solver/engine/device/records.hpp"

namespace qdem::device {

/// Content of ModelView's arrays; lengths of the arrays that go with it.
struct Tables {
  std::vector<BatchRecord> batches;
  std::vector<BodyRecord> bodies;
  std::vector<int> particles, offsets, adjacency, surface_nodes;
  std::vector<double> shapes, weights, volumes;
  std::vector<Triangle> triangles;
  std::vector<Edge> edges;
  std::vector<double> inverse_mass, free_motions;
  std::vector<WorkBlock> quadruple_blocks, bond_blocks, node_blocks, chunk_blocks;
  std::vector<std::int64_t> surface_rows;  ///< [n_bodies + 1]: surface nodes of all bodies before this one
  std::int64_t n_slots = 0, n_rows = 0, n_chunks = 0;
};

Tables make_tables(const Model& model);

/// The pads' cells and, for every node of the pad body, the cells it bears on.
struct PadTables {
  std::vector<double> axes;              ///< [cell][9], columns are the seat axes
  std::vector<proto::PadLaw> laws;       ///< [cell][3]
  std::vector<int> cell_offsets, nodes;  ///< CSR: cell -> nodes
  std::vector<double> weights;           ///< of `nodes`
  std::vector<int> node_offsets, cells;  ///< CSR: node -> cells, ascending
  std::vector<double> cell_weights;      ///< of `cells`
};

PadTables make_pad_tables(const Model& model);

std::vector<PlaneRecord> make_plane_records(const Model& model);
Loads make_loads(const Model& model);

}  // namespace qdem::device
