#include "qdem_solver/engine/relaxation.hpp"

#include <algorithm>
#include <cmath>

namespace qdem {
namespace {

/// Bounds hold for two parts of the motion one by one: each may use half of the step's budget.
constexpr double budget = 0.5;
constexpr int contacts_of_a_particle = 4;  // that may touch at once before any candidate is known

/// How much of a step's budget rates take: dt^2/4 k + dt c <= 1 (see largest_stable_step()).
double demand(const Rates& rates, double dt) {
  return dt * dt / 4 * rates.stiffness + dt * rates.damping;
}

double lightest_particle(const Model& model, int body) {
  double least = model.node_mass(body, 0);
  for (const int node : model.shape(body).surface_nodes) least = std::min(least, model.node_mass(body, node));
  return least;
}

/// Mass that the dashpots of a body's contacts go by: its own; of the ground, which meets stones, the heaviest stone's.
double dashpot_mass(const Model& model, int body) {
  if (model.bodies[body].kind != BodyKind::ground) return model.body_mass(body);
  double heaviest = 0.0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (model.bodies[b].kind == BodyKind::stone) heaviest = std::max(heaviest, model.body_mass(b));
  }
  return heaviest;
}

/// `n` contacts of a body of this mass, each of which moves `moved_mass` alone: its stiffness, and the dashpot
/// 2 zeta sqrt(m k), over the moved mass; doubled for the two sides.
Rates contacts_of(const Model& model, int n, double mass, double moved_mass) {
  const double stiffness = model.contact.normal_stiffness * std::max(1.0, model.contact.tangential_ratio);
  const double dashpot = 2 * model.contact.damping_ratio * std::sqrt(mass * stiffness);
  return {2 * n * stiffness / moved_mass, 2 * n * dashpot / moved_mass};
}

/// Contact points on a rigid body whose mobility is that of a sphere's surface, 1/m + r^2/I = 3.5/m.
Rates rigid_contacts(const Model& model, int n, double mass) {
  return contacts_of(model, n, mass, mass / 3.5);
}

}  // namespace

double relaxation_step(const Model& model, int n_contacts, double safety) {
  double mass = 0.0;
  int n = 0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    if (model.bodies[b].kind != BodyKind::stone) continue;
    mass += model.body_mass(b);
    ++n;
  }
  if (n == 0) mass = model.body_mass(model.pad_body), n = 1;
  const Rates rates = rigid_contacts(model, n_contacts, mass / n);
  const Rates doubled{rates.stiffness / budget, rates.damping / budget};
  return safety * largest_stable_step(doubled);
}

Relaxation::Relaxation(Model& model, int n_contacts, double safety)
    : model_(model),
      n_contacts_(n_contacts),
      safety_(safety),
      step_(relaxation_step(model, n_contacts, safety)),
      elements_(element_rates(model)),
      boundary_(boundary_rates(model)),
      pads_(pad_rates(model)) {}

void Relaxation::begin(Engine& engine, State& state) {
  engine.prepare(state);  // finds the candidates
  fit(engine, state);
  engine.prepare(state);
}

void Relaxation::fit(const Engine& engine, const State& state) {
  const double dt = step_ / safety_;
  const auto contacts = engine.contacts().rates(state, near_gap(model_.contact));
  model_.inertia.resize(model_.bodies.size());
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    const double mass = model_.body_mass(b);
    const Rates touched =
        contacts_of(model_, contacts_of_a_particle, dashpot_mass(model_, b), lightest_particle(model_, b));
    Rates deformation = elements_[b] + boundary_[b] + larger(contacts[b].particle, touched);
    Rates rigid = larger(contacts[b].rigid, rigid_contacts(model_, n_contacts_, mass)) + boundary_[b];
    if (b == model_.pad_body) deformation = deformation + pads_, rigid = rigid + pads_;
    model_.inertia[b].deformation = std::max(1.0, demand(deformation, dt) / budget);
    model_.inertia[b].rigid = std::max(1.0, demand(rigid, dt) / budget);
  }
}

}  // namespace qdem
