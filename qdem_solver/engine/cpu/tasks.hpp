// How the work of one step is cut into tasks that threads take. The cut depends on the model only, never on the number
// of threads, and every sum lies inside one task: this is why results do not depend on the threads.
#pragma once

#include <memory>
#include <vector>

#include "qdem_solver/engine/cpu/blocks.hpp"
#include "qdem_solver/model/model.hpp"

namespace qdem::cpu {

enum class TaskKind {
  batch,   ///< all of a batch of lanes: elements, contact, kick
  outer,   ///< contact and pad forces of a single body
  blocks,  ///< some blocks of elements of a single body, into its slots
  nodes,   ///< some nodes of a single body: gather from slots, kick
};

struct Task {
  TaskKind kind;
  int batch;
  int first = 0, last = 0;  ///< blocks or nodes
};

/// Tasks of the phases; between them all threads meet.
struct TaskList {
  std::vector<Task> forces;  ///< outer, blocks and batch, longest first
  std::vector<Task> nodes;
  std::vector<int> singles;  ///< batches of single bodies, whose kick waits for all their nodes while relaxing
  std::vector<std::shared_ptr<const ElementBlocks>> blocks;  ///< per batch: of a single body, else none
  std::vector<std::int64_t> slot_offsets;  ///< per batch: of its first slot value; -1 for batches of lanes
  std::int64_t n_slot_values = 0;
  int largest_block = 0;  ///< particles
};

TaskList make_tasks(const Model& model);

ElementView view_of(const Template& shape, Interaction interaction);
ElementMaterial material_of(const Material& material);
const ElementKernels& kernels_of(const Kernels& kernels, Interaction interaction);

/// 1/m per value, 0 for held components and spare lanes; laid out like State::x.
std::vector<double> inverse_masses(const Model& model);

/// Six numbers of every body: 1 for a translation along, or a rotation about, an axis through its centre that no fixity
/// holds, else 0. Bodies with fixities are taken to stand as their templates do.
std::vector<double> free_motions(const Model& model);

}  // namespace qdem::cpu
