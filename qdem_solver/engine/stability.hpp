// The largest stable step, computed from the assembled operators.
#pragma once

#include "qdem_solver/contact/contact_stage.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// The integrator's limit for given rates. An oscillation from step to step is an eigenvector of
///     dt^2/4 K + dt C = M,
/// K, C symmetric: the first step for which this has a solution is the largest stable one, so
///     dt = 2/k (sqrt(c^2 + k) - c)        k = stiffness, c = damping
/// With c = 2 xi omega this is (2/omega)(sqrt(1 + 4 xi^2) - 2 xi). Rates of parts may be added: the result is then a
/// lower bound. Source: derived here; README.md says how it was checked.
double largest_stable_step(const Rates& rates);

/// The largest stable step of one model, found again and again while its contacts change. Contacts between bodies are
/// shared out (contact_rates.hpp), so that a body's step follows from its own elements, contacts, pads and loads; the
/// least of all bodies is the system's.
class StepBound {
 public:
  /// One Lanczos run per template and material. It holds for as long as the model keeps bodies, materials and pads.
  explicit StepBound(const Model& model);

  /// Largest stable step [s] as long as no contact forms but between candidates that are now within `gap` [m] of
  /// touching.
  double at(const State& state, const ContactStage& contacts, double gap) const;

  /// at() over what it would be if the materials had no viscosity; the dashpots of contacts and pads stay [-].
  double viscosity_factor(const State& state, const ContactStage& contacts, double gap) const;

 private:
  double least_step(const std::vector<ContactRates>& contacts, bool viscous) const;

  std::vector<Rates> elements_;  ///< of every body
  std::vector<Rates> loads_;     ///< of every body: its loads, and the boundary it lies on
  double weights_;               ///< the least step of the drop weights by themselves [s]
  Rates pads_;
  int pad_body_;
};

/// Rates of a free body of scale 1: largest eigenvalues of the assembled operators with lumped masses, with the error
/// bound of the iteration added.
Rates template_rates(const Template& shape, const Material& material);

/// The same of every body of a model, at its scale.
std::vector<Rates> element_rates(const Model& model);

/// Bound from single quadruples: omega^2 <= 4/rho (lambda + 2 mu) max sum_k |g_k|^2, scale 1.
Rates quadruple_rates(const Template& shape, const Material& material);

/// Bound of the springs and buffers of Model::loads, for every body. Those of a drop weight count twice, since the
/// weight moves, too.
std::vector<Rates> load_rates(const Model& model);

/// Bound of the springs and dashpots of Model::boundary, for every body: each acts on one particle, along the axes.
std::vector<Rates> boundary_rates(const Model& model);

/// Bound of the pads at full engagement, from the operator's weights and the sleeper's particle masses.
Rates pad_rates(const Model& model);

}  // namespace qdem
