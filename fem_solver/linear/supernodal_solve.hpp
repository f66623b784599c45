// Triangular solves with a supernodal Cholesky factor, two branches of the elimination tree at a time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace fem {

/// A factor L as CHOLMOD stores it: supernode s holds the columns first[s] .. first[s+1] as one dense block whose rows
/// are rows[row_begin[s]] .. rows[row_begin[s+1]]; the first of them are the block's own columns. Refers to, does not
/// own.
struct Supernodes {
  using Block = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  int count = 0;
  const int *first = nullptr, *row_begin = nullptr, *value_begin = nullptr, *rows = nullptr;
  const double* values = nullptr;

  int n_columns(int s) const { return first[s + 1] - first[s]; }
  int n_rows(int s) const { return row_begin[s + 1] - row_begin[s]; }
  int n_below(int s) const { return n_rows(s) - n_columns(s); }
  const int* rows_below(int s) const { return rows + row_begin[s] + n_columns(s); }
  Block block(int s) const {
    return {values + value_begin[s], n_rows(s), n_columns(s), Eigen::OuterStride<>(n_rows(s))};
  }
};

/// Solves L L' y = y in place. A solve reads the whole factor twice, at the speed of memory, and one core does not draw
/// all of it: the tree is cut into two branches without common unknowns, for a thread each, and the trunk above them.
/// The cut depends on the factor alone and every sum has a fixed order, so the result does too. (The reference BLAS
/// under cholmod_solve does not reach the speed of memory; Eigen's kernels do.)
class SupernodalSolve {
 public:
  explicit SupernodalSolve(const Supernodes& factor);

  void operator()(Eigen::VectorXd& y) const { solve(y); }
  void operator()(Eigen::MatrixXd& y) const { solve(y); }  ///< several right-hand sides as columns

 private:
  void cut(const std::vector<int>& parent);
  template <class Columns>
  void solve(Columns& y) const;
  template <class Columns>
  void forward(const std::vector<int>& part, Columns& y, Columns& trunk_sum) const;
  template <class Columns>
  void backward(const std::vector<int>& part, Columns& y) const;

  Supernodes factor_;
  std::array<std::vector<int>, 2> branches_;  // supernodes, ascending
  std::vector<int> trunk_;
  std::vector<int> trunk_rows_;   // unknowns of the trunk, ascending
  std::vector<int> trunk_index_;  // of every unknown: its place in trunk_rows_, or -1
};

}  // namespace fem
