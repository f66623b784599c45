#include "fem_solver/linear/cholesky.hpp"

#include <cholmod.h>

#include <Eigen/Dense>

#include "proto/error.hpp"

namespace fem {
namespace {

using Block = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

// CHOLMOD's supernodal factor: supernode s holds the columns super[s] .. super[s+1] as one dense block whose rows are
// s[pi[s]] .. s[pi[s+1]]; the first of them are the block's own columns.
struct Supernodes {
  explicit Supernodes(const cholmod_factor& f)
      : count(static_cast<int>(f.nsuper)),
        first(static_cast<const int*>(f.super)),
        row_begin(static_cast<const int*>(f.pi)),
        value_begin(static_cast<const int*>(f.px)),
        rows(static_cast<const int*>(f.s)),
        values(static_cast<const double*>(f.x)) {}
  int n_columns(int s) const { return first[s + 1] - first[s]; }
  int n_rows(int s) const { return row_begin[s + 1] - row_begin[s]; }
  Block block(int s) const {
    return {values + value_begin[s], n_rows(s), n_columns(s), Eigen::OuterStride<>(n_rows(s))};
  }
  const int* lower_rows(int s) const { return rows + row_begin[s] + n_columns(s); }

  int count;
  const int *first, *row_begin, *value_begin, *rows;
  const double* values;
};

// L y = y, then L' y = y in place. Eigen's kernels run at memory speed, the reference BLAS under cholmod_solve does
// not.
template <class Columns>
void solve_factor(const Supernodes& nodes, Columns& y) {
  Eigen::MatrixXd below;
  for (int s = 0; s < nodes.count; ++s) {
    const int n = nodes.n_columns(s), m = nodes.n_rows(s) - n;
    const Block block = nodes.block(s);
    auto own = y.middleRows(nodes.first[s], n);
    block.topRows(n).template triangularView<Eigen::Lower>().solveInPlace(own);
    below.noalias() = block.bottomRows(m) * own;
    const int* rows = nodes.lower_rows(s);
    for (int i = 0; i < m; ++i) y.row(rows[i]) -= below.row(i);
  }
  for (int s = nodes.count - 1; s >= 0; --s) {
    const int n = nodes.n_columns(s), m = nodes.n_rows(s) - n;
    const Block block = nodes.block(s);
    below.resize(m, y.cols());
    const int* rows = nodes.lower_rows(s);
    for (int i = 0; i < m; ++i) below.row(i) = y.row(rows[i]);
    auto own = y.middleRows(nodes.first[s], n);
    own.noalias() -= block.bottomRows(m).transpose() * below;
    block.topRows(n).transpose().template triangularView<Eigen::Upper>().solveInPlace(own);
  }
}

}  // namespace

struct Cholesky::Data {
  cholmod_common common;
  cholmod_factor* factor = nullptr;

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
    solve_factor(Supernodes(*factor), y);
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
