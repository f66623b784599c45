// Elastic half-spaces in contact: the displacement that tractions on rectangles cause.
#pragma once

#include "fem_solver/contact/hertz.hpp"
#include "fem_solver/contact/patch_compliance.hpp"

namespace fem {

/// Two bodies as one: the combined constants of Kalker, Three-Dimensional Elastic Bodies in Rolling Contact (1990),
///
///     1/G = (1/G1 + 1/G2)/2,   nu/G = (nu1/G1 + nu2/G2)/2,   K/G = ((1 - 2 nu1)/G1 - (1 - 2 nu2)/G2)/4
///
/// K couples the normal to the tangential problem. It is zero for two bodies of one material (quasi-identity), and left
/// out here.
struct PairElasticity {
  double shear_modulus = 0.0;  ///< G [Pa]
  double poisson = 0.0;
  double dissimilarity = 0.0;  ///< K
};

/// Throws proto::Error (bad_data) for a modulus that is not positive, and for |K| above 0.05 (our limit), where leaving
/// it out would show.
PairElasticity pair_elasticity(const ElasticBody& body_1, const ElasticBody& body_2);

/// Which displacement of which traction. `xy` is also `yx`.
enum class Influence { normal, xx, xy, yy };

/// Difference of the two surfaces' displacements at the elements' centres, all moved along x by `shift`, per unit of a
/// constant traction on one element (Boussinesq and Cerruti, integrated over rectangles by Love; Kalker 1990). Depends
/// on the difference of places alone.
class InfluenceTable : public NormalCompliance {
 public:
  /// `shift`: of the points where the displacement is asked for, ahead of the elements' centres [m].
  InfluenceTable(const PatchGrid& grid, const PairElasticity& pair, Influence influence, double shift = 0.0);

  void add(const PatchBox& box, const PatchField& traction, PatchField& displacement) const override;
  /// Where the table is not shifted.
  double self() const override { return values_(n_x_ - 1, n_y_ - 1); }

 private:
  int n_x_, n_y_;
  PatchField values_;  // (2 n_x - 1) x (2 n_y - 1), over the distance from source to target in elements
};

}  // namespace fem
