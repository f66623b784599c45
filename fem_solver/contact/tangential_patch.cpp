#include "fem_solver/contact/tangential_patch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "proto/error.hpp"

namespace fem {
namespace {

constexpr int n_iterations = 2000;
constexpr int n_remembered = 8;      // values of the objective that a step may rise to
constexpr double sufficient = 1e-4;  // part of the predicted decrease that a full step must reach

PatchVectors projected(PatchVectors p, const PatchField& bound) {
  const PatchField norm = p.norm();
  const PatchField factor = (norm > bound).select(bound / norm.max(1e-300), 1.0);
  p.x *= factor, p.y *= factor;
  return p;
}

double dot(const PatchVectors& a, const PatchVectors& b) {
  return (a.x * b.x).sum() + (a.y * b.y).sum();
}

// p - factor g, projected, less p.
PatchVectors projected_step(const PatchVectors& p, const PatchVectors& g, double factor, const PatchField& bound) {
  PatchVectors d = projected({p.x - factor * g.x, p.y - factor * g.y}, bound);
  d.x -= p.x, d.y -= p.y;
  return d;
}

}  // namespace

TangentialInfluence::TangentialInfluence(const PatchGrid& grid, const PairElasticity& pair, double shift)
    : xx_(grid, pair, Influence::xx, shift),
      xy_(grid, pair, Influence::xy, shift),
      yy_(grid, pair, Influence::yy, shift) {}

void TangentialInfluence::add(const PatchBox& box, const PatchVectors& traction, PatchVectors& displacement) const {
  xx_.add(box, traction.x, displacement.x);
  xy_.add(box, traction.y, displacement.x);
  xy_.add(box, traction.x, displacement.y);
  yy_.add(box, traction.y, displacement.y);
}

TangentialPatch::TangentialPatch(const PatchGrid& grid, const PairElasticity& pair)
    : TangentialPatch(grid, std::make_unique<TangentialInfluence>(grid, pair, 0.0)) {}

TangentialPatch::TangentialPatch(const PatchGrid& grid, std::unique_ptr<const ShearCompliance> compliance)
    : grid_(grid), compliance_(std::move(compliance)) {}

TangentialSolution TangentialPatch::solve(const PatchField& bound, const PatchVectors& rigid, const PatchVectors& guess,
                                          double tolerance, const char* where) const {
  TangentialSolution solution{projected(guess, bound), rigid};
  const PatchBox box = bounding_box(bound > 0);
  if (box.empty()) return solution;
  PatchVectors &p = solution.traction, &g = solution.slip;
  const auto gradient = [&] {
    g = rigid;
    compliance_->add(box, p, g);
    ++solution.iterations;
  };
  gradient();
  const double single = 1 / compliance_->self();
  double factor = single / 4;
  // p'A p/2 + rigid'p, since g = A p + rigid.
  const auto objective = [&] { return (dot(g, p) + dot(rigid, p)) / 2; };
  std::array<double, n_remembered> remembered;
  remembered.fill(objective());
  std::ostringstream history;
  bool fresh = true;
  for (int iteration = 0;; ++iteration) {
    const PatchVectors probe = projected_step(p, g, single, bound);
    const double change = probe.norm().maxCoeff(), largest = p.norm().maxCoeff();
    if (iteration % 100 == 0) history << ' ' << change;
    if (change <= tolerance * largest) {
      if (fresh) return solution;
      gradient(), fresh = true;  // the carried slip has met the limit: see whether the true one does
      continue;
    }
    if (iteration == n_iterations || !std::isfinite(change))
      throw proto::Error(proto::ExitCode::numerics,
                         "the shear traction does not converge (changes in Pa:" + history.str() + ")", where,
                         "check the creepages and the friction coefficient");
    PatchVectors d = projected_step(p, g, factor, bound), image = PatchVectors::zeros(grid_);
    compliance_->add(box, d, image);
    ++solution.iterations;
    const double slope = dot(g, d), curvature = dot(d, image), square = dot(d, d);
    // A full step unless the objective would rise above what it was lately; else the exact minimum on the way.
    const double now = objective(), highest = *std::max_element(remembered.begin(), remembered.end());
    const double full = now + slope + curvature / 2;
    const double part = full <= highest + sufficient * slope ? 1.0 : std::min(1.0, -slope / curvature);
    p.x += part * d.x, p.y += part * d.y;
    g.x += part * image.x, g.y += part * image.y;
    fresh = false;
    remembered[static_cast<std::size_t>(iteration % n_remembered)] = now + part * slope + part * part * curvature / 2;
    factor = square / curvature;
  }
}

}  // namespace fem
