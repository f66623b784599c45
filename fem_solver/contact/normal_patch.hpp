// Frictionless contact of two half-spaces on a grid: pressure from the approach.
#pragma once

#include <memory>

#include "fem_solver/contact/half_space.hpp"

namespace fem {

/// Pressure under one approach.
struct NormalSolution {
  PatchField pressure;    ///< >= 0 [Pa]
  double approach = 0.0;  ///< of points far from the patch [m]
  double force = 0.0;     ///< [N]
  double tangent = 0.0;   ///< d force/d approach with the contact set as it is [N/m]
  int iterations = 0;     ///< products with the influence matrix
};

/// p >= 0, g = A p + gap - approach >= 0, p g = 0 by conjugate gradients on the elements in contact, which gain those
/// that overlap and lose those that would pull (Polonsky & Keer, Wear 231, 1999, without its outer force balance).
/// Converged when every |g| in contact and every overlap is at most 1e-12 of the largest undeformed overlap.
class NormalPatch {
 public:
  /// On half-spaces.
  NormalPatch(const PatchGrid& grid, const PairElasticity& pair);
  /// On bodies of this compliance.
  NormalPatch(const PatchGrid& grid, std::unique_ptr<const NormalCompliance> compliance);

  const PatchGrid& grid() const { return grid_; }

  /// `gap`: before deformation [m]; `guess`: pressure to start from. Throws proto::Error (numerics) with the residuals
  /// when 500 iterations do not suffice; `where` is for the message.
  NormalSolution at_approach(const PatchField& gap, double approach, const PatchField& guess, const char* where) const;

  /// Newton's method on the approach until the force is met within 1e-10. `guess` needs an approach and a pressure.
  /// Throws as at_approach(). Whether the patch reaches the edge of the grid is not looked at: require_inside().
  NormalSolution at_force(const PatchField& gap, double force, const NormalSolution& guess, const char* where) const;

 private:
  class Search;
  PatchField tangent_pressure(const PatchBox& box, const PatchField& pressure, int& iterations) const;

  PatchGrid grid_;
  std::unique_ptr<const NormalCompliance> compliance_;
};

}  // namespace fem
