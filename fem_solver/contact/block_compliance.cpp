#include "fem_solver/contact/block_compliance.hpp"

#include <algorithm>

#include "fem_solver/linear/cholesky.hpp"

namespace fem {
namespace {

constexpr int columns_at_once = 64;

// Displacements of the surface's `components` under a unit force on each of them, and on the far boundary the motion
// that belongs to four times that force (the whole body's). The patch is so small that the far motion shifts all of it
// alike: `sense` times that of its middle.
Eigen::MatrixXd flexibility(const BlockSystem& block, const std::vector<int>& components, double sense) {
  const Cholesky factor(block.stiffness, "block in contact");
  std::vector<int> dofs;
  for (const int component : components)
    for (const auto& node : block.surface) dofs.push_back(node[static_cast<std::size_t>(component)]);
  const auto n = static_cast<Eigen::Index>(dofs.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  const auto free = [&](Eigen::Index k) {
    return !block.is_fixed[static_cast<std::size_t>(dofs[static_cast<std::size_t>(k)])];
  };
  for (Eigen::Index first = 0; first < n; first += columns_at_once) {
    const Eigen::Index count = std::min<Eigen::Index>(columns_at_once, n - first);
    Eigen::MatrixXd load = Eigen::MatrixXd::Zero(block.stiffness.rows(), count);
    for (Eigen::Index k = 0; k < count; ++k)
      if (free(first + k)) load(dofs[static_cast<std::size_t>(first + k)], k) = 1.0;
    const Eigen::MatrixXd motion = factor.solve_columns(load);
    for (Eigen::Index row = 0; row < n; ++row)
      if (free(row)) result.row(row).segment(first, count) = motion.row(dofs[static_cast<std::size_t>(row)]);
  }
  result = (result + result.transpose().eval()) / 2;
  const auto n_nodes = static_cast<Eigen::Index>(block.surface.size());
  result.topLeftCorner(n_nodes, n_nodes).array() += 4 * sense * factor.solve(block.far_load)[dofs.front()];
  return result;
}

// Sum over both bodies. A press moves a surface down, so its far motion counts against the force's sense.
Eigen::MatrixXd of_both(const BlockShape& shape, const ElasticBody& wheel, const ElasticBody& rail, BlockLoad load,
                        const std::vector<int>& components, BlockSystem& last) {
  const bool same = wheel.young == rail.young && wheel.poisson == rail.poisson;
  Eigen::MatrixXd sum;
  for (const ElasticBody& body : {wheel, rail}) {
    last = build_block(shape, body, load);
    const Eigen::MatrixXd one = flexibility(last, components, load == BlockLoad::pressing ? -1.0 : 1.0);
    sum = sum.size() == 0 ? one : Eigen::MatrixXd(sum + one);
    if (same) return 2 * one;
  }
  return sum;
}

}  // namespace

BlockNormal::BlockNormal(const BlockShape& shape, const ElasticBody& wheel, const ElasticBody& rail) {
  BlockSystem block;
  matrix_ = of_both(shape, wheel, rail, BlockLoad::pressing, {2}, block);
  grid_ = {block.n_side, block.n_side, block.dx, block.dy};
  matrix_ *= grid_.area();
  n_cells_ = block.n_cells;
}

void BlockNormal::add(const PatchBox&, const PatchField& traction, PatchField& displacement) const {
  const Eigen::VectorXd u = matrix_ * traction.reshaped().matrix();
  displacement += u.array().reshaped(traction.rows(), traction.cols());
}

BlockShear::BlockShear(const BlockShape& shape, const ElasticBody& wheel, const ElasticBody& rail) {
  BlockSystem block;
  matrix_ = of_both(shape, wheel, rail, BlockLoad::shearing, {0, 1}, block);
  matrix_ *= block.dx * block.dy;
}

void BlockShear::add(const PatchBox&, const PatchVectors& traction, PatchVectors& displacement) const {
  const Eigen::Index n = traction.x.size(), rows = traction.x.rows(), columns = traction.x.cols();
  Eigen::VectorXd both(2 * n);
  both << traction.x.reshaped().matrix(), traction.y.reshaped().matrix();
  const Eigen::VectorXd u = matrix_ * both;
  displacement.x += u.head(n).array().reshaped(rows, columns);
  displacement.y += u.tail(n).array().reshaped(rows, columns);
}

double BlockShear::self() const {
  return matrix_.diagonal().head(matrix_.rows() / 2).mean();
}

}  // namespace fem
