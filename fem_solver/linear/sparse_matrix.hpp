// The sparse matrices of the FEM side. Symmetric ones are stored as their lower triangle.
#pragma once

#include <Eigen/SparseCore>

namespace fem {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The whole of a symmetric matrix that is stored as its lower triangle, as a factor of products.
inline auto symmetric(const SparseMatrix& lower) {
  return lower.selfadjointView<Eigen::Lower>();
}

}  // namespace fem
