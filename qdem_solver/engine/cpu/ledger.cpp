// The energy ledger: what is stored in a state, what flowed since the ledger was opened.
#include <algorithm>
#include <cmath>

#include "qdem_solver/engine/cpu/engine_data.hpp"

namespace qdem {

using cpu::Task;
using cpu::TaskKind;

namespace {

double gravity_energy(const Model& model, const State& state) {
  double sum = 0.0;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (int node = 0; node < model.shape(body).n_nodes(); ++node) {
      moment += model.node_mass(body, node) * state.position(model, body, node);
    }
    sum -= model.gravity_on(body).dot(moment);
  }
  return sum;
}

StoredEnergy difference(const StoredEnergy& p, const StoredEnergy& q) {
  return {p.kinetic - q.kinetic, p.strain - q.strain, p.contact - q.contact, p.gravity - q.gravity,
          p.boundary - q.boundary};
}

double sum_of(const StoredEnergy& energy) {
  return energy.kinetic + energy.strain + energy.contact + energy.gravity + energy.boundary;
}

double gained(const StoredEnergy& change) {
  double sum = 0.0;
  for (const double part : {change.kinetic, change.strain, change.contact, change.gravity, change.boundary}) {
    sum += std::max(0.0, part);
  }
  return sum;
}

constexpr double least_share = 1e-3;  // of the elastic energy at the start

/// A number without pattern for every n: the finaliser of splitmix64 (Steele, Lea and Flood 2014).
std::uint64_t scrambled(std::uint64_t n) {
  n += 0x9e3779b97f4a7c15u;
  n = (n ^ (n >> 30)) * 0xbf58476d1ce4e5b9u;
  n = (n ^ (n >> 27)) * 0x94d049bb133111ebu;
  return n ^ (n >> 31);
}

/// Whether the n-th step is the one of its group that is sampled.
bool is_sampled(std::uint64_t n, std::uint64_t group) {
  return n % group == scrambled(n / group) % group;
}

}  // namespace

double EnergyBalance::residual() const {
  return sum_of(change) + dissipated() - work;
}

double Engine::Data::viscous_power(const State& state, const Task& task) {
  const Batch& batch = model.batches[task.batch];
  const Material& solid = model.materials[batch.material_id];
  const auto& law = cpu::kernels_of(kernels, solid.interaction);
  double sum = 0.0;
  if (task.kind == TaskKind::blocks) {
    for (int b = task.first; b < task.last; ++b) sum += law.block_power(block_job(state, task, b));
  }
  if (task.kind != TaskKind::batch) return sum;
  double sums[lane_width];
  law.lane_power({cpu::view_of(model.templates[batch.template_id], solid.interaction), cpu::material_of(solid),
                  batch.scale.data(), &state.x[batch.offset], &state.v[batch.offset], nullptr},
                 sums);
  for (int lane = 0; lane < batch.lanes; ++lane) {
    if (batch.bodies[lane] >= 0) sum += sums[lane];
  }
  return sum;
}

double Engine::viscous_power(const State& state) const {
  Data& d = *data_;
  std::vector<double> parts(d.tasks.forces.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(d.n_threads)
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = d.viscous_power(state, d.tasks.forces[i]);
  double sum = 0.0;
  for (const double part : parts) sum += part;
  return sum;
}

StoredEnergy Engine::stored(const State& state) const {
  const Energies energies = this->energies(state);
  return {energies.kinetic, energies.strain, data_->contact.report(state).elastic_energy,
          gravity_energy(data_->model, state), data_->boundary.energy(state)};
}

void Engine::open_ledger(State& state) const {
  const ContactPower contact_power = state.ledger.contact_power;
  state.ledger = {};
  if (data_->device) return;
  state.ledger.open = true;
  state.ledger.start = stored(state);
  state.ledger.first_step = state.step;
  state.ledger.viscous_time = state.time;
  state.ledger.viscous_power = viscous_power(state);
  state.ledger.radiated_power = data_->boundary.radiated_power(state);
  state.ledger.contact_power = contact_power;
}

EnergyBalance Engine::balance(const State& state) const {
  const EnergyLedger& ledger = state.ledger;
  EnergyBalance balance;
  balance.stored = stored(state);
  if (!ledger.open) return balance;
  balance.open = true;
  balance.change = difference(balance.stored, ledger.start);
  balance.work = ledger.work;
  balance.viscous = ledger.viscous;
  if (state.time > ledger.viscous_time) {
    balance.viscous += 0.5 * (state.time - ledger.viscous_time) * (ledger.viscous_power + viscous_power(state));
  }
  balance.contact_dashpots = ledger.contact_dashpots;
  balance.friction = ledger.friction;
  balance.radiated = ledger.radiated;
  const double elastic = ledger.start.strain + ledger.start.contact + ledger.start.boundary;
  balance.scale = std::max(
      {ledger.largest_work, balance.dissipated(), gained(balance.change), ledger.start.kinetic, least_share * elastic});
  return balance;
}

void Engine::Data::book_contacts(EnergyLedger& ledger, const ContactPower& power, double dt) {
  if (ledger.open) {
    ledger.contact_dashpots += 0.5 * dt * (ledger.contact_power.dashpot + power.dashpot);
    ledger.friction += 0.5 * dt * (ledger.contact_power.friction + power.friction);
  }
  ledger.contact_power = power;
}

void Engine::Data::book_radiation(State& state, double dt) const {
  EnergyLedger& ledger = state.ledger;
  if (!ledger.open) return;
  const double power = boundary.radiated_power(state);
  ledger.radiated += 0.5 * dt * (ledger.radiated_power + power);
  ledger.radiated_power = power;
}

void Engine::Data::book_work(EnergyLedger& ledger, double work) {
  if (!ledger.open) return;
  ledger.work += work;
  ledger.largest_work = std::max(ledger.largest_work, std::abs(ledger.work));
}

void Engine::book_viscosity(State& state) const {
  EnergyLedger& ledger = state.ledger;
  const auto n = static_cast<std::uint64_t>(state.step - ledger.first_step);
  if (!ledger.open || !is_sampled(n, data_->options.steps_per_viscous_sample)) return;
  const double power = viscous_power(state);
  ledger.viscous += 0.5 * (state.time - ledger.viscous_time) * (ledger.viscous_power + power);
  ledger.viscous_time = state.time, ledger.viscous_power = power;
}

}  // namespace qdem
