// The pads of the rail seats as the sleeper feels them: cell values from particles, forces back to particles.
#pragma once

#include <vector>

#include "proto/span.hpp"
#include "qdem_solver/model/model.hpp"

namespace qdem {

/// The pads' operator from the sleeper's particles to the cells, and its transpose. Rows sum to one and reproduce rigid
/// motions because every row interpolates within surface triangles (see bed or case set-up that fills PadCell).
class PadOperator {
 public:
  explicit PadOperator(const Model& model);

  std::size_t n_values() const { return 3 * cells_->size(); }

  /// Cell values in seat axes of a vector field laid out like State::x: sum of weight x (axes^T field).
  void apply(proto::Span<const double> field, proto::Span<double> values) const;
  /// Adds the transposed: particle forces of given cell forces in seat axes [N].
  void add_transposed(proto::Span<const double> values, proto::Span<double> force) const;
  /// Forces on the sleeper by the pads' laws for rail motion u, u' and sleeper motion x, x', all per cell and axis.
  void forces(proto::Span<const double> u, proto::Span<const double> u_rate, proto::Span<const double> x,
              proto::Span<const double> x_rate, proto::Span<double> force) const;

 private:
  const std::vector<PadCell>* cells_;
  std::vector<std::vector<std::int64_t>> indices_;  ///< of component 0 of each cell's nodes
  std::int64_t stride_ = 1;
};

}  // namespace qdem
