#include "qdem_solver/state/state.hpp"

#include "proto/error.hpp"

namespace qdem {

State make_state(const Model& model, const std::vector<Placement>& placements) {
  if (placements.size() != model.bodies.size()) {
    throw proto::Error(proto::ExitCode::internal, std::to_string(placements.size()) + " placements for " +
                                                      std::to_string(model.bodies.size()) + " bodies");
  }
  State state;
  for (auto* values : {&state.x, &state.v, &state.a}) values->assign(model.n_values, 0.0);
  state.pad_force.assign(3 * model.pads.size(), 0.0);
  for (const Batch& batch : model.batches) {
    const Template& shape = model.templates[batch.template_id];
    for (int lane = 0; lane < batch.lanes; ++lane) {
      const int body = batch.bodies[lane] >= 0 ? batch.bodies[lane] : batch.bodies[0];
      const Placement& place = placements[body];
      for (int node = 0; node < shape.n_nodes(); ++node) {
        const Eigen::Vector3d x = place.rotation * (batch.scale[lane] * shape.nodes[node]) + place.translation;
        for (int c = 0; c < 3; ++c) state.x[batch.offset + (node * 3 + c) * batch.lanes + lane] = x[c];
      }
    }
  }
  return state;
}

}  // namespace qdem
