// The largest stable step, computed from the assembled operators.
#pragma once

#include "qdem_solver/contact/contact_stage.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Upper bounds of stiffness and damping over mass of one part of the system: the largest eigenvalues of M^-1 K [1/s2]
/// and M^-1 C [1/s].
struct Rates {
  double stiffness = 0.0;
  double damping = 0.0;
};
Rates operator+(const Rates& p, const Rates& q);

/// The integrator's limit for given rates. An oscillation from step to step is an eigenvector of
///     dt^2/4 K + dt C = M,
/// K, C symmetric: the first step for which this has a solution is the largest stable one, so
///     dt = 2/k (sqrt(c^2 + k) - c)        k = stiffness, c = damping
/// With c = 2 xi omega this is (2/omega)(sqrt(1 + 4 xi^2) - 2 xi). Rates of parts may be added: the result is then a
/// lower bound. Source: derived here; README.md says how it was checked.
double largest_stable_step(const Rates& rates);

struct StabilityReport {
  Rates elements, contacts, pads;
  double largest_step = 0.0;  ///< of everything together [s]
  double element_step = 0.0;  ///< from the quadruples alone, one by one: cheap, and below the assembled figure [s]
};

/// Assembled bound (Lanczos, one run per template and material) of the model at `state`'s contact candidates.
StabilityReport stability(const Model& model, const State& state, const ContactStage& contact);

/// Rates of a free body of scale 1: largest eigenvalues of the assembled operators with lumped masses, with the error
/// bound of the iteration added.
Rates template_rates(const Template& shape, const Material& material);

/// The same of every body of a model, at its scale.
std::vector<Rates> element_rates(const Model& model);

/// Rates of the contacts on a particle from ContactRates::particle. Dashpots are set by their ratio zeta to the
/// features' effective mass, so n touching contacts of stiffness over mass q give a row sum 4 zeta n sqrt(q), and
/// `stiffness` is 2 N q for N candidates: the damping covers n = sqrt(2 N) simultaneous contacts of one particle.
Rates particle_contact_rates(double stiffness, double damping_ratio);

/// Bound from single quadruples: omega^2 <= 4/rho (lambda + 2 mu) max sum_k |g_k|^2, scale 1.
Rates quadruple_rates(const Template& shape, const Material& material);

/// Bound of the pads at full engagement, from the operator's weights and the sleeper's particle masses.
Rates pad_rates(const Model& model);

}  // namespace qdem
