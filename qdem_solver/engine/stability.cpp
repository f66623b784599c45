#include "qdem_solver/engine/stability.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <utility>

#include "qdem_solver/model/bond_network.hpp"

namespace qdem {
namespace {

constexpr int lanczos_steps = 60;

/// M^-1/2 K M^-1/2 of a body of scale 1, K linear elasticity with Lame constants (lambda, mu).
class ScaledStiffness {
 public:
  ScaledStiffness(const Template& shape, double lambda, double mu, double density)
      : shape_(shape), lambda_(lambda), mu_(mu), inverse_root_(shape.n_nodes()) {
    for (int i = 0; i < shape.n_nodes(); ++i) inverse_root_[i] = 1 / std::sqrt(density * shape.node_volumes[i]);
  }

  Eigen::VectorXd operator()(const Eigen::VectorXd& y) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(y.size());
    for (int e = 0; e < shape_.n_tets(); ++e) {
      const auto& tet = shape_.tets[e];
      const Eigen::Matrix3d g =
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shape_.gradients[e].data());
      const Eigen::Vector3d first = inverse_root_[tet[0]] * y.segment<3>(3 * tet[0]);
      Eigen::Matrix3d du;
      for (int k = 0; k < 3; ++k) du.col(k) = inverse_root_[tet[k + 1]] * y.segment<3>(3 * tet[k + 1]) - first;
      const Eigen::Matrix3d gradient = du * g;
      const Eigen::Matrix3d stress =
          lambda_ * gradient.trace() * Eigen::Matrix3d::Identity() + mu_ * (gradient + gradient.transpose());
      const Eigen::Matrix3d force = shape_.volumes[e] * stress * g.transpose();
      for (int k = 0; k < 3; ++k) result.segment<3>(3 * tet[k + 1]) += inverse_root_[tet[k + 1]] * force.col(k);
      result.segment<3>(3 * tet[0]) -= inverse_root_[tet[0]] * force.rowwise().sum();
    }
    return result;
  }

 private:
  const Template& shape_;
  double lambda_, mu_;
  std::vector<double> inverse_root_;
};

/// M^-1/2 K M^-1/2 of a body of scale 1 with the bonds of E = 1.
class ScaledBonds {
 public:
  ScaledBonds(const Template& shape, double density) : stiffness_(bond_stiffness(shape, bonds_of(shape))) {
    Eigen::VectorXd inverse_root(stiffness_.rows());
    for (Eigen::Index i = 0; i < inverse_root.size(); ++i) {
      inverse_root[i] = 1 / std::sqrt(density * shape.node_volumes[i / 3]);
    }
    stiffness_ = inverse_root.asDiagonal() * stiffness_ * inverse_root.asDiagonal();
  }

  Eigen::VectorXd operator()(const Eigen::VectorXd& y) const { return stiffness_ * y; }

 private:
  Eigen::SparseMatrix<double> stiffness_;
};

/// Largest eigenvalue of a symmetric operator: Lanczos estimate plus the residual of its vector, which bounds the error
/// of the nearest eigenvalue.
template <class Operator>
double largest_eigenvalue(const Operator& op, Eigen::Index n) {
  std::mt19937_64 random(20240229);
  Eigen::VectorXd now(n), before = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) now[i] = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  now.normalize();
  const int steps = static_cast<int>(std::min<Eigen::Index>(lanczos_steps, n));
  Eigen::VectorXd diagonal(steps), off(steps);
  double beta = 0.0;
  int done = 0;
  while (done < steps) {
    Eigen::VectorXd next = op(now) - beta * before;
    diagonal[done] = now.dot(next);
    next -= diagonal[done] * now;
    beta = off[done] = next.norm();
    ++done;
    if (beta < 1e-12 * std::abs(diagonal[0])) break;
    before = now, now = next / beta;
  }
  // As a full matrix: computeFromTridiagonal does not scale its input, and gave 1/30 of the largest eigenvalue for
  // stones with one stiff sliver.
  Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(done, done);
  projected.diagonal() = diagonal.head(done);
  if (done > 1) projected.diagonal(1) = projected.diagonal(-1) = off.head(done - 1);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(projected);
  return solver.eigenvalues()[done - 1] + beta * std::abs(solver.eigenvectors()(done - 1, done - 1));
}

double largest_eigenvalue(const Template& shape, double lambda, double mu, double density) {
  if (lambda == 0 && mu == 0) return 0.0;
  return largest_eigenvalue(ScaledStiffness(shape, lambda, mu, density), 3 * shape.n_nodes());
}

/// Elasticity of a scaled body: stiffness over mass goes with 1/s^2, so does viscosity over mass.
Rates scaled(const Rates& rates, double scale) {
  return {rates.stiffness / (scale * scale), rates.damping / (scale * scale)};
}

/// Rates of every body; `rates_of` gives those of a template and material at scale 1.
template <class RatesOf>
std::vector<Rates> of_bodies(const Model& model, RatesOf rates_of) {
  std::map<std::pair<int, int>, Rates> known;
  std::vector<Rates> result;
  for (const Body& body : model.bodies) {
    const auto key = std::make_pair(body.template_id, body.material_id);
    auto found = known.find(key);
    if (found == known.end()) {
      const Rates rates = rates_of(model.templates[body.template_id], model.materials[body.material_id]);
      found = known.emplace(key, rates).first;
    }
    result.push_back(scaled(found->second, body.scale));
  }
  return result;
}

}  // namespace

double largest_stable_step(const Rates& rates) {
  const double k = rates.stiffness, c = rates.damping;
  if (k <= 0) return c > 0 ? 1 / c : std::numeric_limits<double>::infinity();
  return 2 / (std::sqrt(c * c + k) + c);  // = 2/k (sqrt(c^2 + k) - c) without cancellation
}

Rates template_rates(const Template& shape, const Material& material) {
  if (material.interaction == Interaction::bond) {
    const double unit = largest_eigenvalue(ScaledBonds(shape, material.density), 3 * shape.n_nodes());
    return {material.young * unit, material.tensile_viscosity() * unit};
  }
  return {largest_eigenvalue(shape, material.lambda(), material.mu(), material.density),
          largest_eigenvalue(shape, material.lame_viscosity, material.shear_viscosity, material.density)};
}

std::vector<Rates> element_rates(const Model& model) {
  return of_bodies(model, template_rates);
}

Rates quadruple_rates(const Template& shape, const Material& material) {
  double largest = 0.0;
  for (const auto& gradients : shape.gradients) {
    const Eigen::Matrix3d g = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(gradients.data());
    largest = std::max(largest, g.squaredNorm() + g.colwise().sum().squaredNorm());
  }
  const double factor = 4 / material.density * largest;
  return {factor * (material.lambda() + 2 * material.mu()),
          factor * (material.lame_viscosity + 2 * material.shear_viscosity)};
}

Rates pad_rates(const Model& model) {
  if (model.pads.empty()) return {};
  std::map<int, Rates> nodes;
  for (const PadCell& cell : model.pads) {
    double stiffness = 0.0, damping = 0.0;
    for (const auto& law : cell.laws) {
      stiffness = std::max(stiffness, law.stiffness), damping = std::max(damping, law.damping);
    }
    double row = 0.0;  // more than one where a point lies a little outside its tetrahedron
    for (const double weight : cell.weights) row += std::abs(weight);
    for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
      const double share = row * std::abs(cell.weights[i]) / model.node_mass(model.pad_body, cell.nodes[i]);
      nodes[cell.nodes[i]].stiffness += share * stiffness, nodes[cell.nodes[i]].damping += share * damping;
    }
  }
  Rates largest;
  for (const auto& [node, rates] : nodes) largest = larger(largest, rates);
  return largest;
}

std::vector<Rates> load_rates(const Model& model) {
  std::vector<Rates> result(model.bodies.size());
  for (const PatchLoad& load : model.loads) {
    const double sides = load.kind == LoadKind::drop_weight ? 2 : 1;
    double row = 0.0, most = 0.0;
    for (const double weight : load.patch.weights) row += std::abs(weight);
    for (std::size_t i = 0; i < load.patch.nodes.size(); ++i) {
      const double mass = model.node_mass(load.patch.body, load.patch.nodes[i]);
      most = std::max(most, row * std::abs(load.patch.weights[i]) / mass);
    }
    Rates& body = result[load.patch.body];
    body = body + Rates{sides * load.stiffness * most, sides * load.damping * most};
  }
  return result;
}

std::vector<Rates> boundary_rates(const Model& model) {
  std::vector<Rates> result(model.bodies.size());
  for (const BoundaryParticle& p : model.boundary) {
    const double mass = model.node_mass(p.body, p.node);
    result[p.body] = larger(result[p.body], {p.stiffness.maxCoeff() / mass, p.damping.maxCoeff() / mass});
  }
  return result;
}

StepBound::StepBound(const Model& model)
    : elements_(element_rates(model)),
      loads_(load_rates(model)),
      weights_(std::numeric_limits<double>::infinity()),
      pads_(pad_rates(model)),
      pad_body_(model.pad_body) {
  const auto beyond = boundary_rates(model);
  for (std::size_t b = 0; b < beyond.size(); ++b) loads_[b] = loads_[b] + beyond[b];
  for (const PatchLoad& load : model.loads) {
    if (load.kind != LoadKind::drop_weight) continue;
    weights_ = std::min(weights_, largest_stable_step({2 * load.stiffness / load.mass, 2 * load.damping / load.mass}));
  }
}

double StepBound::least_step(const std::vector<ContactRates>& contacts, bool viscous) const {
  double step = weights_;
  for (int b = 0; b < static_cast<int>(elements_.size()); ++b) {
    Rates rates = elements_[b];
    if (!viscous) rates.damping = 0.0;
    rates = rates + loads_[b];
    if (b == pad_body_) rates = rates + pads_;
    step = std::min(step, largest_stable_step(rates + contacts[b].particle));
  }
  return step;
}

double StepBound::at(const State& state, const ContactStage& contacts, double gap) const {
  return least_step(contacts.rates(state, gap), true);
}

double StepBound::viscosity_factor(const State& state, const ContactStage& contacts, double gap) const {
  const auto rates = contacts.rates(state, gap);
  return least_step(rates, true) / least_step(rates, false);
}

}  // namespace qdem
