#include "fem_solver/contact/normal_patch.hpp"

#include <cmath>
#include <sstream>

#include "proto/error.hpp"

namespace fem {
namespace {

constexpr double tolerance = 1e-12;         // of the gap, over the largest undeformed overlap
constexpr double tangent_tolerance = 1e-8;  // of the pressure under a unit rise of the approach
constexpr double force_tolerance = 1e-10;
constexpr int n_iterations = 500, n_newton = 60;

using Mask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

[[noreturn]] void refuse(const std::string& what, const std::ostringstream& history, const char* where) {
  throw proto::Error(proto::ExitCode::numerics, what + " (" + history.str().substr(1) + ")", where,
                     "check the gap, the moduli and the load");
}

}  // namespace

NormalPatch::NormalPatch(const PatchGrid& grid, const PairElasticity& pair)
    : NormalPatch(grid, std::make_unique<InfluenceTable>(grid, pair, Influence::normal)) {}

NormalPatch::NormalPatch(const PatchGrid& grid, std::unique_ptr<const NormalCompliance> compliance)
    : grid_(grid), compliance_(std::move(compliance)) {}

NormalSolution NormalPatch::at_approach(const PatchField& gap, double approach, const PatchField& guess,
                                        const char* where) const {
  if (!std::isfinite(approach)) throw proto::Error(proto::ExitCode::numerics, "the approach is not a number", where);
  NormalSolution solution{grid_.zeros(), approach};
  const PatchField overlap = approach - gap;
  // Pressure only pushes the surfaces apart, so that what does not overlap undeformed will never touch.
  const Mask candidates = overlap > 0;
  const PatchBox box = bounding_box(candidates);
  if (box.empty()) return solution;
  const double largest = overlap.maxCoeff();

  PatchField& p = solution.pressure;
  p = candidates.select(guess.max(0.0), 0.0);
  if ((p <= 0).all()) p = candidates.select(overlap / (compliance_->self() * box.n_i), 0.0);

  PatchField g = grid_.zeros(), direction = grid_.zeros(), image = grid_.zeros();
  const auto residual_gap = [&] {
    g = -overlap;
    compliance_->add(box, p, g);
    ++solution.iterations;
  };
  residual_gap();
  std::ostringstream history;
  double square_before = 1.0;
  bool conjugate = false, fresh = true;
  for (int iteration = 0;; ++iteration) {
    const Mask contact = p > 0;
    const double error = contact.select(g.abs(), candidates.select((-g).max(0.0), 0.0)).maxCoeff() / largest;
    history << ' ' << error;
    if (error <= tolerance && fresh) break;
    if (iteration == n_iterations || !std::isfinite(error))
      refuse("the contact pressure does not converge: largest gap error over the overlap", history, where);
    if (error <= tolerance) {  // the carried gap has met the limit: see whether the true one does
      residual_gap(), fresh = true;
      continue;
    }
    const double square = contact.select(g.square(), 0.0).sum();
    direction = contact.select(conjugate ? (g + square / square_before * direction).eval() : g, 0.0);
    square_before = square;
    image.setZero();
    compliance_->add(box, direction, image);
    ++solution.iterations;
    const double curvature = (direction * image).sum();
    const double length = curvature > 0 ? (g * direction).sum() / curvature : 1 / compliance_->self();
    p -= length * direction;
    const Mask pulled = p < 0, pressed = candidates && !contact && g < 0;
    conjugate = !pulled.any() && !pressed.any();
    if (conjugate) {
      g -= length * image, fresh = false;
      continue;
    }
    p = pulled.select(0.0, p);
    p = pressed.select(-length * g, p);
    residual_gap(), fresh = true;
  }
  solution.force = p.sum() * grid_.area();
  solution.tangent = tangent_pressure(box, p, solution.iterations).sum() * grid_.area();
  return solution;
}

// Pressure per unit of approach with the contact set held: A q = 1 on it, by conjugate gradients.
PatchField NormalPatch::tangent_pressure(const PatchBox& box, const PatchField& pressure, int& iterations) const {
  const Mask contact = pressure > 0;
  PatchField q = grid_.zeros(), residual = contact.select(PatchField::Ones(grid_.n_x, grid_.n_y), 0.0);
  PatchField direction = residual, image = grid_.zeros();
  const double begin = residual.square().sum();
  double square = begin;
  for (int k = 0; k < n_iterations && square > tangent_tolerance * tangent_tolerance * begin; ++k, ++iterations) {
    image.setZero();
    compliance_->add(box, direction, image);
    const double length = square / (direction * image).sum();
    q += length * direction;
    residual = contact.select(residual - length * image, 0.0);
    const double next = residual.square().sum();
    direction = residual + next / square * direction;
    square = next;
  }
  return q;
}

NormalSolution NormalPatch::at_force(const PatchField& gap, double force, const NormalSolution& guess,
                                     const char* where) const {
  NormalSolution now = at_approach(gap, guess.approach, guess.pressure, where);
  std::ostringstream history;
  int iterations = now.iterations;
  for (int k = 0; std::abs(now.force - force) > force_tolerance * force; ++k) {
    history << ' ' << now.force / force - 1;
    if (k == n_newton || !(now.tangent > 0))
      refuse("no approach gives the contact force: relative errors", history, where);
    now = at_approach(gap, now.approach + (force - now.force) / now.tangent, now.pressure, where);
    iterations += now.iterations;
  }
  now.iterations = iterations;
  return now;
}

}  // namespace fem
