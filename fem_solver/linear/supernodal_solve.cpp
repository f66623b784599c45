#include "fem_solver/linear/supernodal_solve.hpp"

#include <algorithm>
#include <future>
#include <queue>
#include <utility>

namespace fem {
namespace {

constexpr double largest_share = 0.1;    // of the factor in one subtree, so that two branches can be balanced
constexpr double smallest_factor = 2e5;  // entries; below it a second thread costs more than it saves

std::vector<int> parents(const Supernodes& f) {
  std::vector<int> of_column(f.first[f.count]), parent(f.count, -1);
  for (int s = 0; s < f.count; ++s) std::fill(&of_column[0] + f.first[s], &of_column[0] + f.first[s + 1], s);
  for (int s = 0; s < f.count; ++s) {
    if (f.n_below(s) > 0) parent[s] = of_column[f.rows_below(s)[0]];
  }
  return parent;
}

}  // namespace

SupernodalSolve::SupernodalSolve(const Supernodes& factor) : factor_(factor) {
  cut(parents(factor));
  trunk_index_.assign(factor.first[factor.count], -1);
  for (const int s : trunk_) {
    for (int column = factor.first[s]; column < factor.first[s + 1]; ++column) {
      trunk_index_[column] = static_cast<int>(trunk_rows_.size());
      trunk_rows_.push_back(column);
    }
  }
}

void SupernodalSolve::cut(const std::vector<int>& parent) {
  const int n = factor_.count;
  std::vector<double> weight(n);
  std::vector<std::vector<int>> children(n + 1);
  double total = 0.0;
  for (int s = 0; s < n; ++s) {  // children come before their parents
    const double own = static_cast<double>(factor_.n_rows(s)) * factor_.n_columns(s);
    weight[s] += own, total += own;
    if (parent[s] >= 0) weight[parent[s]] += weight[s];
    children[parent[s] >= 0 ? parent[s] : n].push_back(s);
  }
  // The heaviest subtree is opened until all are small: its root joins the trunk.
  std::vector<int> owner(n, -1);  // 0, 1: branch; -1: trunk
  std::priority_queue<std::pair<double, int>> subtrees;
  for (const int root : children[n]) subtrees.push({weight[root], root});
  std::array<double, 2> load{};
  while (!subtrees.empty()) {
    const auto [heavy, root] = subtrees.top();
    subtrees.pop();
    if (total > smallest_factor && heavy > largest_share * total) {
      for (const int child : children[root]) subtrees.push({weight[child], child});
      continue;
    }
    const int lighter = total > smallest_factor && load[1] < load[0] ? 1 : 0;
    load[lighter] += heavy, owner[root] = lighter;
  }
  for (int s = n - 1; s >= 0; --s) {
    if (owner[s] < 0 && parent[s] >= 0) owner[s] = owner[parent[s]];
  }
  for (int s = 0; s < n; ++s) (owner[s] < 0 ? trunk_ : branches_[owner[s]]).push_back(s);
}

// What the part adds to unknowns of the trunk goes to `trunk_sum`, so that branches share nothing.
template <class Columns>
void SupernodalSolve::forward(const std::vector<int>& part, Columns& y, Columns& trunk_sum) const {
  Columns below;
  for (const int s : part) {
    const int n = factor_.n_columns(s), m = factor_.n_below(s);
    const auto block = factor_.block(s);
    auto own = y.middleRows(factor_.first[s], n);
    block.topRows(n).template triangularView<Eigen::Lower>().solveInPlace(own);
    below.noalias() = block.bottomRows(m) * own;
    const int* rows = factor_.rows_below(s);
    for (int i = 0; i < m; ++i) {
      const int at = trunk_index_[rows[i]];
      if (at >= 0) {
        trunk_sum.row(at) += below.row(i);
      } else {
        y.row(rows[i]) -= below.row(i);
      }
    }
  }
}

template <class Columns>
void SupernodalSolve::backward(const std::vector<int>& part, Columns& y) const {
  Columns below;
  for (auto it = part.rbegin(); it != part.rend(); ++it) {
    const int s = *it, n = factor_.n_columns(s), m = factor_.n_below(s);
    const auto block = factor_.block(s);
    below.resize(m, y.cols());
    const int* rows = factor_.rows_below(s);
    for (int i = 0; i < m; ++i) below.row(i) = y.row(rows[i]);
    auto own = y.middleRows(factor_.first[s], n);
    own.noalias() -= block.bottomRows(m).transpose() * below;
    block.topRows(n).transpose().template triangularView<Eigen::Upper>().solveInPlace(own);
  }
}

template <class Columns>
void SupernodalSolve::solve(Columns& y) const {
  const auto n_trunk = static_cast<Eigen::Index>(trunk_rows_.size());
  const auto both = [&](const auto& work) {
    if (branches_[1].empty()) return work(0);
    auto second = std::async(std::launch::async, work, 1);
    work(0);
    second.get();
  };
  std::array<Columns, 2> sums;
  for (auto& sum : sums) sum.setZero(n_trunk, y.cols());
  both([&](int b) { forward(branches_[b], y, sums[b]); });

  for (Eigen::Index i = 0; i < n_trunk; ++i) y.row(trunk_rows_[i]) -= sums[0].row(i) + sums[1].row(i);
  Columns sum = Columns::Zero(n_trunk, y.cols());  // of what lower parts of the trunk add to higher ones
  for (const int s : trunk_) {
    const int first = factor_.first[s], n = factor_.n_columns(s);
    y.middleRows(first, n) -= sum.middleRows(trunk_index_[first], n);
    forward({s}, y, sum);
  }
  backward(trunk_, y);
  both([&](int b) { backward(branches_[b], y); });
}

template void SupernodalSolve::solve(Eigen::VectorXd&) const;
template void SupernodalSolve::solve(Eigen::MatrixXd&) const;

}  // namespace fem
