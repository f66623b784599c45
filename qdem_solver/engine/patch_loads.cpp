#include "qdem_solver/engine/patch_loads.hpp"

#include <algorithm>

namespace qdem {

PatchLoads::PatchLoads(const Model& model) : model_(model) {
  for (const PatchLoad& load : model.loads) {
    auto& indices = indices_.emplace_back();
    for (const int node : load.patch.nodes) indices.push_back(model.index(load.patch.body, node));
  }
}

double PatchLoads::along(std::size_t load, const std::vector<double>& field) const {
  const Patch& patch = model_.loads[load].patch;
  const int stride = model_.stride(patch.body);
  double sum = 0.0;
  for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
    const auto at = indices_[load][i];
    const Eigen::Vector3d value(field[at], field[at + stride], field[at + 2 * stride]);
    sum += patch.weights[i] * patch.direction.dot(value);
  }
  return sum;
}

double PatchLoads::fall(const PatchLoad& load, LoadState& weight, double path, double rate, double time,
                        double dt) const {
  const double gravity = model_.gravity.dot(load.patch.direction);
  if (time <= load.start) {
    weight.position = path, weight.velocity = load.speed, weight.acceleration = gravity;
    return 0.0;
  }
  const double step = std::min(dt, time - load.start);
  weight.position += step * (weight.velocity + step / 2 * weight.acceleration);
  const double predicted = weight.velocity + step * weight.acceleration;
  const double overlap = weight.position - path;
  double force = 0.0;
  if (overlap > 0) force = std::max(0.0, load.stiffness * overlap + load.damping * (predicted - rate));
  const double acceleration = gravity - force / load.mass;
  weight.velocity += step / 2 * (weight.acceleration + acceleration);
  weight.acceleration = acceleration;
  return force;
}

double PatchLoads::update(State& state, double dt) const {
  if (state.loads.size() != model_.loads.size()) {
    state.loads.assign(model_.loads.size(), {});
    for (std::size_t i = 0; i < model_.loads.size(); ++i) state.loads[i].origin = along(i, state.x);
  }
  double work = 0.0;
  for (std::size_t i = 0; i < model_.loads.size(); ++i) {
    const PatchLoad& load = model_.loads[i];
    LoadState& now = state.loads[i];
    const double path = along(i, state.x) - now.origin;
    double force = 0.0;
    switch (load.kind) {
      case LoadKind::force:
        force = load.history(state.time);
        break;
      case LoadKind::displacement:
        force = load.stiffness * (load.history(state.time) - path);
        break;
      case LoadKind::drop_weight:
        force = fall(load, now, path, along(i, state.v), state.time, dt);
        break;
    }
    work += 0.5 * (now.force + force) * (path - now.path);
    now.path = path, now.force = force;
  }
  return work;
}

void PatchLoads::add(int body, const State& state, proto::Span<double> force) const {
  for (std::size_t i = 0; i < indices_.size(); ++i) {
    const Patch& patch = model_.loads[i].patch;
    if (patch.body != body) continue;
    const int stride = model_.stride(body);
    for (std::size_t k = 0; k < patch.nodes.size(); ++k) {
      const Eigen::Vector3d share = patch.weights[k] * state.loads[i].force * patch.direction;
      for (int c = 0; c < 3; ++c) force[indices_[i][k] + c * stride] += share[c];
    }
  }
}

}  // namespace qdem
