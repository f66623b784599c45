#include "fem_solver/time/interface_solve.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <sstream>

#include "proto/error.hpp"

namespace fem {
namespace {

constexpr int n_iterations = 60;
constexpr double tolerance = 1e-11;

struct Evaluation {
  Eigen::VectorXd residual;  // of the pads, then of the contact
  Eigen::VectorXd tangent;   // d law/d w of each cell, 0 where only the clip pulls
  double contact_tangent = 0.0, approach = 0.0;
};

Evaluation evaluate(const InterfaceProblem& p, const Eigen::VectorXd& unknowns) {
  const int n = static_cast<int>(p.laws.size());
  const Eigen::VectorXd used = unknowns.head(n) - p.carry;
  const double contact = unknowns[n];
  const Eigen::VectorXd w = p.free_velocity - p.compliance * used - p.contact_column * contact;
  Evaluation e{Eigen::VectorXd(n + 1), Eigen::VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    const double gap = p.gap_0[i] + p.time_factor * w[i], rate = p.rate_factor * (w[i] - p.sleeper_velocity[i]);
    e.residual[i] = unknowns[i] - p.laws[i].force(gap, rate);
    e.tangent[i] = p.laws[i].tangent(gap, rate, p.time_factor, p.rate_factor);
  }
  if (!p.contact_law) {
    e.residual[n] = contact - p.given_contact;
    return e;
  }
  e.approach = p.approach_0 - p.time_factor * p.contact_column.dot(used) - p.contact_slope * contact;
  const ContactForce law = p.contact_law(e.approach);
  e.residual[n] = contact - law.force;
  e.contact_tangent = law.tangent;
  return e;
}

Eigen::MatrixXd jacobian(const InterfaceProblem& p, const Evaluation& e) {
  const int n = static_cast<int>(p.laws.size());
  Eigen::MatrixXd j = Eigen::MatrixXd::Identity(n + 1, n + 1);
  j.topLeftCorner(n, n) += e.tangent.asDiagonal() * p.compliance;
  j.topRightCorner(n, 1) += e.tangent.cwiseProduct(p.contact_column);
  j.bottomLeftCorner(1, n) += e.contact_tangent * p.time_factor * p.contact_column.transpose();
  j(n, n) += e.contact_tangent * p.contact_slope;
  return j;
}

}  // namespace

InterfaceSolution solve_interface(const InterfaceProblem& problem, const InterfaceSolution& guess, const char* where) {
  const int n = static_cast<int>(problem.laws.size());
  Eigen::VectorXd unknowns(n + 1);
  unknowns << guess.force, guess.contact;
  Evaluation now = evaluate(problem, unknowns);
  std::ostringstream history;
  for (int iteration = 0; iteration <= n_iterations; ++iteration) {
    const double size = now.residual.lpNorm<Eigen::Infinity>();
    history << ' ' << size;
    if (!std::isfinite(size)) break;
    if (size <= tolerance * std::max(1.0, unknowns.lpNorm<Eigen::Infinity>()))
      return {unknowns.head(n), std::max(unknowns[n], 0.0), iteration, now.approach};
    const Eigen::VectorXd step = jacobian(problem, now).partialPivLu().solve(now.residual);
    double part = 1.0;
    Eigen::VectorXd tried = unknowns - step;
    Evaluation next = evaluate(problem, tried);
    while (next.residual.norm() > now.residual.norm() && part > 1e-3) {
      part /= 2;
      tried = unknowns - part * step;
      next = evaluate(problem, tried);
    }
    unknowns = tried, now = next;
  }
  throw proto::Error(proto::ExitCode::numerics,
                     "pads and wheel contact do not converge (residuals in N:" + history.str() + ")", where,
                     "reduce coupling.window_s");
}

}  // namespace fem
