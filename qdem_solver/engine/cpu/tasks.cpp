#include "qdem_solver/engine/cpu/tasks.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "qdem_solver/model/bond_network.hpp"

namespace qdem::cpu {
namespace {

constexpr int nodes_per_task = 512;

void cut(std::vector<Task>& tasks, TaskKind kind, int batch, int n, int size) {
  for (int first = 0; first < n; first += size) tasks.push_back({kind, batch, first, std::min(n, first + size)});
}

}  // namespace

TaskList make_tasks(const Model& model) {
  TaskList list;
  std::vector<Task> batches;
  std::map<std::pair<int, int>, std::shared_ptr<const ElementBlocks>> of_kind;  // by template and material
  for (int b = 0; b < static_cast<int>(model.batches.size()); ++b) {
    const Batch& batch = model.batches[b];
    const Template& shape = model.templates[batch.template_id];
    const ElementView elements = view_of(shape, model.materials[batch.material_id].interaction);
    if (batch.lanes > 1) {
      batches.push_back({TaskKind::batch, b, 0, elements.n_elements});
      list.blocks.push_back(nullptr), list.slot_offsets.push_back(-1);
      continue;
    }
    const auto [made, missing] = of_kind.try_emplace({batch.template_id, batch.material_id});
    if (missing) made->second = std::make_shared<const ElementBlocks>(make_blocks(elements, shape.nodes));
    const ElementBlocks& blocks = *made->second;
    list.forces.push_back({TaskKind::outer, b});
    cut(list.forces, TaskKind::blocks, b, static_cast<int>(blocks.blocks.size()), 1);
    cut(list.nodes, TaskKind::nodes, b, shape.n_nodes(), nodes_per_task);
    list.singles.push_back(b);
    list.blocks.push_back(made->second), list.slot_offsets.push_back(list.n_slot_values);
    list.n_slot_values += 4 * static_cast<std::int64_t>(blocks.copies.size());
    for (const auto& block : blocks.blocks) list.largest_block = std::max(list.largest_block, block.n_copies);
  }
  std::stable_sort(batches.begin(), batches.end(), [](const Task& p, const Task& q) { return p.last > q.last; });
  list.forces.insert(list.forces.end(), batches.begin(), batches.end());
  return list;
}

ElementView view_of(const Template& shape, Interaction interaction) {
  if (interaction == Interaction::bond) {
    const BondNetwork& bonds = bonds_of(shape);
    return {static_cast<int>(bonds.nodes.size()),
            BondForce<double>::n_particles,
            BondForce<double>::n_shape,
            bonds.nodes.data()->data(),
            bonds.lengths.data(),
            bonds.stiffness.data(),
            bonds.adjacency.offsets.data(),
            bonds.adjacency.slots.data()};
  }
  return {shape.n_tets(),
          QuadrupleForce<double>::n_particles,
          QuadrupleForce<double>::n_shape,
          shape.tets.data()->data(),
          shape.gradients.data()->data(),
          shape.volumes.data(),
          shape.adjacency_offsets.data(),
          shape.adjacency_slots.data()};
}

ElementMaterial material_of(const Material& material) {
  return {{material.lambda(), material.mu(), material.lame_viscosity, material.shear_viscosity},
          {material.young, material.tensile_viscosity()}};
}

const ElementKernels& kernels_of(const Kernels& kernels, Interaction interaction) {
  return interaction == Interaction::bond ? kernels.bond : kernels.quadruple;
}

std::vector<double> inverse_masses(const Model& model) {
  std::vector<double> result(model.n_values, 0.0);
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    for (int node = 0; node < model.shape(body).n_nodes(); ++node) {
      for (int c = 0; c < 3; ++c) {
        result[model.index(body, node) + c * model.stride(body)] = 1 / model.node_mass(body, node);
      }
    }
  }
  for (const Fixity& held : model.fixities) {
    for (int c = 0; c < 3; ++c) {
      if (held.mask >> c & 1u) result[model.index(held.body, held.node) + c * model.stride(held.body)] = 0.0;
    }
  }
  return result;
}

std::vector<double> free_motions(const Model& model) {
  std::vector<double> free(6 * model.bodies.size(), 1.0);
  for (const Fixity& held : model.fixities) {
    const Template& shape = model.shape(held.body);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int i = 0; i < shape.n_nodes(); ++i) centre += shape.node_volumes[i] / shape.volume() * shape.nodes[i];
    const Eigen::Vector3d arm = shape.nodes[held.node] - centre;
    for (int c = 0; c < 3; ++c) {
      if (!(held.mask >> c & 1u)) continue;
      double* of_body = &free[6 * held.body];
      of_body[c] = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        const double moved = Eigen::Vector3d::Unit(axis).cross(arm)[c];
        if (std::abs(moved) > 1e-9 * arm.norm()) of_body[3 + axis] = 0.0;
      }
    }
  }
  return free;
}

}  // namespace qdem::cpu
