// The sleeper's bottom, cut into cells along and across the track.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "proto/result/attributes.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Which particles of the bottom belong to which cell. A particle on the line between cells belongs to both in equal
/// parts, on a corner to four: it is listed as four quarters.
class BottomCells {
 public:
  struct Quarter {
    int node, cell;  ///< cells along x, then along y
  };

  BottomCells(const Model& model, std::array<int, 2> cells);

  int body() const { return body_; }
  std::size_t n_cells() const { return static_cast<std::size_t>(cells_[0]) * cells_[1]; }
  std::vector<std::size_t> shape() const {
    return {static_cast<std::size_t>(cells_[0]), static_cast<std::size_t>(cells_[1])};
  }
  const std::vector<Quarter>& quarters() const { return quarters_; }
  double cell_length(int axis) const;  ///< [m]

  /// `name`.cell_length_m, .cell_width_m, and the bottom's box in `reference`: .x_min_m, .x_max_m, .y_min_m, .y_max_m,
  /// .z_m (mean) in the global frame.
  proto::Attributes place(const std::string& name, const State& reference) const;

 private:
  int cell_of(const Eigen::Vector3d& at) const;

  std::array<int, 2> cells_;
  const Model& model_;
  int body_;
  Eigen::Vector3d low_, high_;  ///< of the template's box
  std::vector<Quarter> quarters_;
};

}  // namespace qdem
