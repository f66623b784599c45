#include "qdem_solver/sensors/bottom_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qdem {
namespace {

using Eigen::Vector3d;

constexpr double same_place = 1e-9;  // [template lengths]

}  // namespace

BottomCells::BottomCells(const Model& model, std::array<int, 2> cells)
    : cells_(cells), model_(model), body_(model.pad_body) {
  const Template& shape = model.shape(body_);
  low_ = high_ = shape.nodes.front();
  for (const Vector3d& node : shape.nodes) low_ = low_.cwiseMin(node), high_ = high_.cwiseMax(node);
  for (const int node : shape.surface_nodes) {
    const Vector3d& at = shape.nodes[node];
    if (at[2] > low_[2] + same_place) continue;
    for (const double dx : {-same_place, same_place}) {
      for (const double dy : {-same_place, same_place}) quarters_.push_back({node, cell_of(at + Vector3d(dx, dy, 0))});
    }
  }
}

double BottomCells::cell_length(int axis) const {
  return model_.bodies[body_].scale * (high_[axis] - low_[axis]) / cells_[axis];
}

int BottomCells::cell_of(const Vector3d& at) const {
  int index[2];
  for (int axis = 0; axis < 2; ++axis) {
    const double share = (at[axis] - low_[axis]) / (high_[axis] - low_[axis]);
    index[axis] = std::clamp(static_cast<int>(std::floor(share * cells_[axis])), 0, cells_[axis] - 1);
  }
  return index[0] * cells_[1] + index[1];
}

proto::Attributes BottomCells::place(const std::string& name, const State& reference) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vector3d low = Vector3d::Constant(infinity), high = -low, sum = Vector3d::Zero();
  for (const auto& quarter : quarters_) {
    const Vector3d at = reference.position(model_, body_, quarter.node);
    low = low.cwiseMin(at), high = high.cwiseMax(at), sum += at;
  }
  return {{name + ".cell_length_m", cell_length(0)},
          {name + ".cell_width_m", cell_length(1)},
          {name + ".x_min_m", low[0]},
          {name + ".x_max_m", high[0]},
          {name + ".y_min_m", low[1]},
          {name + ".y_max_m", high[1]},
          {name + ".z_m", sum[2] / static_cast<double>(quarters_.size())}};
}

}  // namespace qdem
