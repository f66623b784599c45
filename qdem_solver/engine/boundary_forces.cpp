#include "qdem_solver/engine/boundary_forces.hpp"

namespace qdem {

BoundaryForces::BoundaryForces(const Model& model) : entries_(model.bodies.size()) {
  for (const BoundaryParticle& particle : model.boundary) {
    entries_[particle.body].push_back(
        {&particle, model.index(particle.body, particle.node), model.stride(particle.body)});
  }
}

void BoundaryForces::add(int body, const State& state, proto::Span<double> force) const {
  for (const Entry& entry : entries_[body]) {
    const BoundaryParticle& p = *entry.particle;
    for (int c = 0; c < 3; ++c) {
      const auto i = entry.index + c * entry.stride;
      force[i] -= p.stiffness[c] * (state.x[i] - p.rest[c]) + p.damping[c] * state.v[i];
    }
  }
}

double BoundaryForces::radiated_power(const State& state) const {
  double sum = 0.0;
  for (const auto& of_body : entries_) {
    for (const Entry& entry : of_body) {
      for (int c = 0; c < 3; ++c) {
        const double v = state.v[entry.index + c * entry.stride];
        sum += entry.particle->damping[c] * v * v;
      }
    }
  }
  return sum;
}

double BoundaryForces::energy(const State& state) const {
  double sum = 0.0;
  for (const auto& of_body : entries_) {
    for (const Entry& entry : of_body) {
      for (int c = 0; c < 3; ++c) {
        const double u = state.x[entry.index + c * entry.stride] - entry.particle->rest[c];
        sum += 0.5 * entry.particle->stiffness[c] * u * u;
      }
    }
  }
  return sum;
}

}  // namespace qdem
