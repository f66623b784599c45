#include "fem_solver/linear/cholesky.hpp"

#include <cholmod.h>

#include <optional>

#include "fem_solver/linear/supernodal_solve.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

Supernodes supernodes_of(const cholmod_factor& f) {
  return {static_cast<int>(f.nsuper),    static_cast<const int*>(f.super), static_cast<const int*>(f.pi),
          static_cast<const int*>(f.px), static_cast<const int*>(f.s),     static_cast<const double*>(f.x)};
}

}  // namespace

struct Cholesky::Data {
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  std::optional<SupernodalSolve> triangular;

  Data() { cholmod_start(&common); }
  ~Data() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }

  template <class Columns>
  Columns solve(const Columns& right) const {
    const int* permutation = static_cast<const int*>(factor->Perm);
    Columns y(right.rows(), right.cols());
    for (Eigen::Index i = 0; i < right.rows(); ++i) y.row(i) = right.row(permutation[i]);
    (*triangular)(y);
    Columns x(right.rows(), right.cols());
    for (Eigen::Index i = 0; i < right.rows(); ++i) x.row(permutation[i]) = y.row(i);
    return x;
  }
};

Cholesky::Cholesky(const Eigen::SparseMatrix<double>& lower, const std::string& name)
    : data_(std::make_unique<Data>()) {
  Eigen::SparseMatrix<double> compressed = lower;
  compressed.makeCompressed();
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(compressed.rows());
  view.nzmax = static_cast<std::size_t>(compressed.nonZeros());
  view.p = compressed.outerIndexPtr(), view.i = compressed.innerIndexPtr(), view.x = compressed.valuePtr();
  view.stype = -1;
  view.itype = CHOLMOD_INT, view.xtype = CHOLMOD_REAL, view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1, view.packed = 1;

  // One ordering, so that the factor does not hang on a contest between several; nested dissection suits the long,
  // slender mesh.
  auto& common = data_->common;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_METIS;
  common.postorder = 1;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.print = 0;
  data_->factor = cholmod_analyze(&view, &common);
  if (data_->factor) cholmod_factorize(&view, data_->factor, &common);
  if (common.status == CHOLMOD_NOT_POSDEF)
    throw proto::Error(proto::ExitCode::bad_data, "the matrix of the " + name + " is not positive definite", "[fem]",
                       "check that supports and material leave no free motion");
  if (common.status != CHOLMOD_OK || !data_->factor)
    throw proto::Error(
        proto::ExitCode::os_error,
        "the matrix of the " + name + " cannot be factorised (CHOLMOD status " + std::to_string(common.status) + ")",
        "[fem]", "if memory is short, raise element_length_m or lower n_bays");
  data_->triangular.emplace(supernodes_of(*data_->factor));
}

Cholesky::~Cholesky() = default;

Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& right) const {
  return data_->solve(right);
}

Eigen::MatrixXd Cholesky::solve_columns(const Eigen::MatrixXd& right) const {
  return data_->solve(right);
}

double Cholesky::n_factor_entries() const {
  return static_cast<double>(data_->factor->xsize);
}

}  // namespace fem
