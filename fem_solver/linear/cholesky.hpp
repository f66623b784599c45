// Sparse Cholesky factor of a symmetric positive definite matrix (CHOLMOD, supernodal, nested dissection).
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <string>

namespace fem {

/// Factorised once, solved many times. Not copyable; a const object's solve() may not be called from two threads.
class Cholesky {
 public:
  /// `lower`: lower triangle of the matrix. `name` appears in the error's text.
  /// Throws proto::Error (bad_data) when the matrix is not positive definite.
  Cholesky(const Eigen::SparseMatrix<double>& lower, const std::string& name);
  ~Cholesky();

  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve_columns(const Eigen::MatrixXd& right) const;

  /// Entries of the factor, a measure of what one solve costs.
  double n_factor_entries() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace fem
