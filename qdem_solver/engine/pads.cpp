#include "qdem_solver/engine/pads.hpp"

namespace qdem {

PadOperator::PadOperator(const Model& model) : cells_(&model.pads) {
  if (model.pads.empty()) return;
  stride_ = model.stride(model.pad_body);
  for (const PadCell& cell : model.pads) {
    auto& indices = indices_.emplace_back();
    for (const int node : cell.nodes) indices.push_back(model.index(model.pad_body, node));
  }
}

void PadOperator::apply(proto::Span<const double> field, proto::Span<double> values) const {
  for (std::size_t cell = 0; cell < cells_->size(); ++cell) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < indices_[cell].size(); ++i) {
      const auto at = indices_[cell][i];
      sum += (*cells_)[cell].weights[i] * Eigen::Vector3d(field[at], field[at + stride_], field[at + 2 * stride_]);
    }
    const Eigen::Vector3d value = (*cells_)[cell].axes.transpose() * sum;
    for (int c = 0; c < 3; ++c) values[3 * cell + c] = value[c];
  }
}

void PadOperator::add_transposed(proto::Span<const double> values, proto::Span<double> force) const {
  for (std::size_t cell = 0; cell < cells_->size(); ++cell) {
    const Eigen::Vector3d global =
        (*cells_)[cell].axes * Eigen::Vector3d(values[3 * cell], values[3 * cell + 1], values[3 * cell + 2]);
    for (std::size_t i = 0; i < indices_[cell].size(); ++i) {
      for (int c = 0; c < 3; ++c) force[indices_[cell][i] + c * stride_] += (*cells_)[cell].weights[i] * global[c];
    }
  }
}

void PadOperator::forces(proto::Span<const double> u, proto::Span<const double> u_rate, proto::Span<const double> x,
                         proto::Span<const double> x_rate, proto::Span<double> force) const {
  for (std::size_t i = 0; i < n_values(); ++i) {
    force[i] = (*cells_)[i / 3].laws[i % 3].force(u[i] - x[i], u_rate[i] - x_rate[i]);
  }
}

}  // namespace qdem
