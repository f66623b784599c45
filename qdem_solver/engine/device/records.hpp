// The model as kernels see it: numbers only, gathered in a few arrays.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "qdem_solver/contact/body_skin.hpp"
#include "qdem_solver/engine/cpu/kernels.hpp"
#include "qdem_solver/engine/device/pointer.hpp"
#include "qdem_solver/model/model.hpp"

namespace qdem::device {

/// Items of a kernel that belong to one batch; every block of `block_size` items has one.
struct WorkBlock {
  int batch;
  int first;  ///< of the batch's items
};
inline constexpr int block_size = 128;

/// Particles whose movement one item takes together.
inline constexpr int chunk_size = 8;

/// One batch. Names that end in `_at` are positions in the arrays of ModelView.
struct BatchRecord {
  int lanes, n_nodes, n_elements, n_chunks;
  std::int64_t values_at;  ///< in arrays laid out like State::x
  std::int64_t slots_at;   ///< [element][corner][component][lane]
  std::int64_t rows_at;    ///< particle (node, lane) has row rows_at + node * lanes + lane
  std::int64_t chunks_at;  ///< [chunk][lane]
  std::int64_t particles_at, shapes_at, weights_at, offsets_at, adjacency_at, volumes_at;
  cpu::ElementMaterial material;
  double density;  ///< [kg/m3]
  double scale[lane_width];
  int bodies[lane_width];  ///< -1: spare lane
};

struct BodyRecord {
  std::int64_t values_at;  ///< of component 0 of node 0
  std::int64_t row;        ///< of node 0; node n has row + n * lanes
  int lanes, lane, batch;
  bool is_sleeper;
  double mass_factor, mass;  ///< see SkinView
  std::int64_t surface_at, triangles_at, edges_at;
  int n_surface_nodes, n_triangles, n_edges;
};

/// Immutable arrays of a model, and counts.
struct ModelView {
  Pointer<const BatchRecord> batches;
  Pointer<const BodyRecord> bodies;
  Pointer<const int> particles, offsets, adjacency, surface_nodes;
  Pointer<const double> shapes, weights, volumes;
  Pointer<const Triangle> triangles;
  Pointer<const Edge> edges;
  Pointer<const double> inverse_mass;  ///< like State::x
  Pointer<const double> free_motions;  ///< [body][6], see cpu::free_motions()
  Pointer<const WorkBlock> quadruple_blocks, bond_blocks, node_blocks, chunk_blocks;
  int n_bodies;
};

/// What a kernel of blocks works on. batch: nullptr for an item that fills up the last block of a batch.
struct Place {
  const BatchRecord* batch = nullptr;
  int lane = 0, number = 0;  ///< number: of the element, node or chunk
};

HOUSE_HOST_DEVICE inline Place place_of(const Access& at, const ModelView& model, Pointer<const WorkBlock> blocks,
                                        std::int64_t item, int BatchRecord::*count) {
  const WorkBlock block = at(blocks)[item / block_size];
  const BatchRecord* batch = at(model.batches) + block.batch;
  const int local = block.first + static_cast<int>(item % block_size);
  if (local >= batch->*count * batch->lanes) return {};
  if (batch->lanes == 1) return {batch, 0, local};
  return {batch, local % lane_width, local / lane_width};
}

/// The skin of a body as the contact functors want it.
HOUSE_HOST_DEVICE inline SkinView skin_of(const Access& at, const ModelView& model, int body) {
  const BodyRecord& record = at(model.bodies)[body];
  SkinView skin;
  skin.triangles = at(model.triangles) + record.triangles_at;
  skin.edges = at(model.edges) + record.edges_at;
  skin.offset = record.values_at, skin.stride = record.lanes;
  skin.mass_factor = record.mass_factor, skin.mass = record.mass;
  return skin;
}

/// A plane's numbers.
struct PlaneRecord {
  double point[3], normal[3], velocity[3];
  double friction;
  bool touches_stones, touches_sleeper;
};

/// The same for the contact functors.
struct PlaneNow {
  Eigen::Vector3d point, normal, velocity;
  double friction;
  HOUSE_HOST_DEVICE explicit PlaneNow(const PlaneRecord& plane)
      : point(plane.point[0], plane.point[1], plane.point[2]),
        normal(plane.normal[0], plane.normal[1], plane.normal[2]),
        velocity(plane.velocity[0], plane.velocity[1], plane.velocity[2]),
        friction(plane.friction) {}
};

/// Numbers of the model that may change between calls.
struct Loads {
  double gravity[3];
  double local_damping, drag;
  double load_density[3];  ///< Model::pad_body_load over the pad body's volume at scale 1 [N/m3]
};

/// Mutable arrays of a state, laid out like State's.
struct MotionView {
  Pointer<double> x, v, a;
};

/// How far the steps of one call have come. Kernels of a step do nothing once the candidate list is used up or the
/// motion is not finite any more; the host looks after the last one.
struct Clock {
  std::int64_t done;  ///< steps
  int stale;          ///< a body or plane has moved by half the skin
  int blown;          ///< a motion is not finite
  int halted;         ///< the step in which that happened is over
};

HOUSE_HOST_DEVICE inline bool waits(const Access& at, Pointer<const Clock> clock) {
  return at(clock)->stale != 0 || at(clock)->blown != 0;
}

/// The steps of one call; set before it.
struct StepFrame {
  double dt;
  double start;  ///< State::time before the first step [s]
  std::int64_t n_steps;
  HOUSE_HOST_DEVICE double time(std::int64_t step) const { return start + static_cast<double>(step) * dt; }
};

}  // namespace qdem::device
