// Compliance of blocks of finite elements at the nodes of their finest surface.
#pragma once

#include <Eigen/Core>

#include "fem_solver/contact/block_mesh.hpp"
#include "fem_solver/contact/patch_compliance.hpp"

namespace fem {

/// Nodes of a quarter of the patch; a node's traction is its force in the quarter over a whole element's area. Two
/// blocks add up, each with its own factorisation; one for both if their materials are the same.
class BlockNormal : public NormalCompliance {
 public:
  BlockNormal(const BlockShape& shape, const ElasticBody& wheel, const ElasticBody& rail);

  const PatchGrid& grid() const { return grid_; }
  int n_cells() const { return n_cells_; }
  void add(const PatchBox& box, const PatchField& traction, PatchField& displacement) const override;
  double self() const override { return matrix_.diagonal().mean(); }

 private:
  PatchGrid grid_;
  int n_cells_ = 0;
  Eigen::MatrixXd matrix_;  // [m/Pa]
};

/// Shear along x, even in x and y; the traction across is odd in both.
class BlockShear : public ShearCompliance {
 public:
  BlockShear(const BlockShape& shape, const ElasticBody& wheel, const ElasticBody& rail);

  void add(const PatchBox& box, const PatchVectors& traction, PatchVectors& displacement) const override;
  double self() const override;

 private:
  Eigen::MatrixXd matrix_;  // of all x, then of all y [m/Pa]
};

}  // namespace fem
