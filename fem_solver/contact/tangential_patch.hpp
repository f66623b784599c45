// Friction between two half-spaces on a grid: shear traction from the rigid slip.
#pragma once

#include <memory>

#include "fem_solver/contact/half_space.hpp"

namespace fem {

/// The three tables of the tangential influence, their points `shift` ahead [m].
class TangentialInfluence : public ShearCompliance {
 public:
  TangentialInfluence(const PatchGrid& grid, const PairElasticity& pair, double shift);

  void add(const PatchBox& box, const PatchVectors& traction, PatchVectors& displacement) const override;
  double self() const override { return xx_.self(); }

 private:
  InfluenceTable xx_, xy_, yy_;
};

struct TangentialSolution {
  PatchVectors traction;  ///< on the wheel [Pa]
  PatchVectors slip;      ///< of the wheel over the rail in this step [m]
  int iterations = 0;     ///< products with the influence matrix
};

/// One step of friction: with the slip s = rigid + A p, every element has |p| <= bound, s = 0 where |p| < bound, and
/// else s opposite to p (Kalker 1990, ch. 4: the minimum of p'A p/2 + rigid'p over discs). Solved by the spectral
/// projected gradient method (Birgin, Martinez & Raydan, SIAM J. Optim. 10, 2000).
class TangentialPatch {
 public:
  /// On half-spaces.
  TangentialPatch(const PatchGrid& grid, const PairElasticity& pair);
  /// On bodies of this compliance.
  TangentialPatch(const PatchGrid& grid, std::unique_ptr<const ShearCompliance> compliance);

  const PatchGrid& grid() const { return grid_; }

  /// `bound`: friction times pressure [Pa]; `rigid`: slip of the undeformed surfaces in this step less the displacement
  /// that the material brings along [m]; `guess`: traction to start from. Converged when a projected gradient step on
  /// one element alone changes no traction by more than `tolerance` of the largest. Throws proto::Error (numerics) with
  /// the history after 2000 iterations; `where` is for the message.
  TangentialSolution solve(const PatchField& bound, const PatchVectors& rigid, const PatchVectors& guess,
                           double tolerance, const char* where) const;

 private:
  PatchGrid grid_;
  std::unique_ptr<const ShearCompliance> compliance_;
};

}  // namespace fem
