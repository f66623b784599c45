// What the engine reports about a state. Not in the hot loop.
#include <algorithm>
#include <cmath>

#include "qdem_solver/engine/cpu/engine_data.hpp"
#include "qdem_solver/model/bond_network.hpp"
#include "qdem_solver/physics/quadruple_energy.hpp"

namespace qdem {
namespace {

double quadruple_energy(const Model& model, const State& state, int body) {
  const Template& shape = model.shape(body);
  const double scale = model.bodies[body].scale;
  const auto material = cpu::material_of(model.material(body)).quadruple;
  double sum = 0.0;
  for (int e = 0; e < shape.n_tets(); ++e) {
    const Eigen::Vector3d first = state.position(model, body, shape.tets[e][0]);
    Eigen::Matrix3d dx;
    for (int k = 0; k < 3; ++k) dx.col(k) = state.position(model, body, shape.tets[e][k + 1]) - first;
    const Eigen::Matrix3d g = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shape.gradients[e].data());
    sum += scale * scale * scale * shape.volumes[e] * energy_density(deformation_gradient(dx, g, scale), material);
  }
  return sum;
}

double bond_energy(const Model& model, const State& state, int body) {
  const BondNetwork& bonds = bonds_of(model.shape(body));
  const BondForce<double> force{model.bodies[body].scale, cpu::material_of(model.material(body)).bond};
  double sum = 0.0;
  for (std::size_t b = 0; b < bonds.nodes.size(); ++b) {
    const auto& [first, second] = bonds.nodes[b];
    const Eigen::Vector3d dx = state.position(model, body, second) - state.position(model, body, first);
    sum += force.energy(dx.data(), bonds.lengths[b], bonds.stiffness[b]);
  }
  return sum;
}

double strain_energy(const Model& model, const State& state, int body) {
  const bool bonded = model.material(body).interaction == Interaction::bond;
  return bonded ? bond_energy(model, state, body) : quadruple_energy(model, state, body);
}

double kinetic_energy_of(const Model& model, const State& state, int body) {
  double sum = 0.0;
  for (int node = 0; node < model.shape(body).n_nodes(); ++node) {
    sum += 0.5 * model.node_mass(body, node) * state.velocity(model, body, node).squaredNorm();
  }
  return sum;
}

}  // namespace

Energies Engine::energies(const State& state) const {
  const Model& model = data_->model;
  const int n = static_cast<int>(model.bodies.size());
  std::vector<Energies> parts(n);
#pragma omp parallel for schedule(dynamic, 8) num_threads(data_->n_threads)
  for (int body = 0; body < n; ++body) {
    parts[body] = {kinetic_energy_of(model, state, body), strain_energy(model, state, body)};
  }
  Energies sum;
  for (const Energies& part : parts) sum.kinetic += part.kinetic, sum.strain += part.strain;
  return sum;
}

double Engine::kinetic_energy(const State& state) const {
  const Model& model = data_->model;
  double sum = 0.0;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    sum += kinetic_energy_of(model, state, body);
  }
  return sum;
}

double Engine::largest_speed(const State& state) const {
  const Model& model = data_->model;
  double largest = 0.0;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    for (int node = 0; node < model.shape(body).n_nodes(); ++node) {
      largest = std::max(largest, state.velocity(model, body, node).squaredNorm());
    }
  }
  return std::sqrt(largest);
}

double Engine::unbalanced_ratio(const State& state) const {
  const Model& model = data_->model;
  std::vector<double> contact(model.n_values, 0.0), pads(model.n_values, 0.0), beyond(model.n_values, 0.0);
  data_->pads.add_transposed(state.pad_force, pads);
  double resultants = 0.0, contacts = 0.0;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    data_->contact.gather(body, contact);
    data_->boundary.add(body, state, beyond);
    Eigen::Vector3d sum = model.body_mass(body) * model.gravity_on(body);
    if (body == model.pad_body) sum += model.pad_body_load;
    for (int node = 0; node < model.shape(body).n_nodes(); ++node) {
      const Eigen::Vector3d touch = State::gather(model, contact, body, node);
      sum += touch + State::gather(model, pads, body, node) + State::gather(model, beyond, body, node);
      contacts += touch.norm();
    }
    const double* free = &data_->free_motions[6 * body];
    resultants += sum.cwiseProduct(Eigen::Vector3d(free[0], free[1], free[2])).norm();
  }
  return contacts > 0 ? resultants / contacts : (resultants > 0 ? 1.0 : 0.0);
}

std::vector<double> Engine::pad_displacement(const State& state, const std::vector<double>& reference) const {
  std::vector<double> x = data_->pad_values(state.x);
  const std::vector<double> x0 = data_->pad_values(reference);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] -= x0[i];
  return x;
}

std::vector<double> Engine::pad_velocity(const State& state) const {
  return data_->pad_values(state.v);
}

}  // namespace qdem
