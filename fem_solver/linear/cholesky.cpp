#include "fem_solver/linear/cholesky.hpp"

#include <Eigen/CholmodSupport>

#include "proto/error.hpp"

namespace fem {

struct Cholesky::Data {
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor;
};

Cholesky::Cholesky(const Eigen::SparseMatrix<double>& lower, const std::string& name)
    : data_(std::make_unique<Data>()) {
  auto& settings = data_->factor.cholmod();
  // One ordering, so that the factor does not depend on a contest between several; nested dissection suits the long,
  // slender mesh.
  settings.nmethods = 1;
  settings.method[0].ordering = CHOLMOD_METIS;
  settings.postorder = 1;
  settings.print = 0;
  data_->factor.compute(lower);
  if (data_->factor.info() != Eigen::Success)
    throw proto::Error(proto::ExitCode::bad_data, "the matrix of the " + name + " is not positive definite", "[fem]",
                       "check that supports and material leave no free motion");
}

Cholesky::~Cholesky() = default;

Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& right) const {
  return data_->factor.solve(right);
}

Eigen::MatrixXd Cholesky::solve_columns(const Eigen::MatrixXd& right) const {
  return data_->factor.solve(right);
}

double Cholesky::n_factor_entries() const {
  return data_->factor.cholmod().lnz;
}

}  // namespace fem
