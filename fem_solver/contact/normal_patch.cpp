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

// One problem on its way: pressure p, the gap g that it leaves, and the direction of search.
class NormalPatch::Search {
 public:
  PatchBox box;  // of all that can touch
  PatchField pressure;
  bool gap_is_true = true;
  int products = 0;

  Search(const NormalCompliance& compliance, const PatchField& overlap, const PatchField& guess)
      : compliance_(compliance), overlap_(overlap), candidates_(overlap > 0) {
    box = bounding_box(candidates_);
    if (box.empty()) {
      pressure = PatchField::Zero(overlap.rows(), overlap.cols());
      return;
    }
    largest_ = overlap.maxCoeff();
    pressure = candidates_.select(guess.max(0.0), 0.0);
    if ((pressure <= 0).all()) pressure = candidates_.select(overlap / (compliance.self() * box.n_i), 0.0);
    find_gap();
  }

  /// Largest gap in contact or overlap outside, over the largest undeformed overlap.
  double error() const {
    const PatchField outside = candidates_.select((-gap_).max(0.0), 0.0);
    return (pressure > 0).select(gap_.abs(), outside).maxCoeff() / largest_;
  }

  /// g = A p - overlap, instead of the one that the steps have carried along.
  void find_gap() {
    gap_ = -overlap_;
    compliance_.add(box, pressure, gap_);
    ++products, gap_is_true = true;
  }

  void step() {
    const Mask contact = pressure > 0;
    const double square = contact.select(gap_.square(), 0.0).sum();
    if (conjugate_)
      direction_ = contact.select(gap_ + square / square_ * direction_, 0.0);
    else
      direction_ = contact.select(gap_, 0.0);
    square_ = square;
    PatchField image = PatchField::Zero(gap_.rows(), gap_.cols());
    compliance_.add(box, direction_, image);
    ++products;
    const double curvature = (direction_ * image).sum();
    const double length = curvature > 0 ? (gap_ * direction_).sum() / curvature : 1 / compliance_.self();
    pressure -= length * direction_;
    const Mask pulled = pressure < 0, pressed = candidates_ && !contact && gap_ < 0;
    conjugate_ = !pulled.any() && !pressed.any();
    if (conjugate_) {
      gap_ -= length * image, gap_is_true = false;
      return;
    }
    pressure = pulled.select(0.0, pressure);
    pressure = pressed.select(-length * gap_, pressure);
    find_gap();
  }

 private:
  const NormalCompliance& compliance_;
  const PatchField& overlap_;
  Mask candidates_;  // pressure only pushes the surfaces apart: what does not overlap undeformed never touches
  PatchField gap_, direction_;
  double largest_ = 1.0, square_ = 1.0;
  bool conjugate_ = false;
};

NormalSolution NormalPatch::at_approach(const PatchField& gap, double approach, const PatchField& guess,
                                        const char* where) const {
  if (!std::isfinite(approach)) throw proto::Error(proto::ExitCode::numerics, "the approach is not a number", where);
  const PatchField overlap = approach - gap;
  Search search(*compliance_, overlap, guess);
  NormalSolution solution{search.pressure, approach};
  if (search.box.empty()) return solution;
  std::ostringstream history;
  for (int iteration = 0;; ++iteration) {
    const double error = search.error();
    history << ' ' << error;
    if (error <= tolerance && search.gap_is_true) break;
    if (iteration == n_iterations || !std::isfinite(error))
      refuse("the contact pressure does not converge: largest gap error over the overlap", history, where);
    if (error <= tolerance)
      search.find_gap();
    else
      search.step();
  }
  solution.pressure = search.pressure;
  solution.force = search.pressure.sum() * grid_.area();
  solution.iterations = search.products;
  solution.tangent = tangent_pressure(search.box, search.pressure, solution.iterations).sum() * grid_.area();
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
