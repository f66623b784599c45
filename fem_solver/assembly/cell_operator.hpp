// From the rail foot to the cells of rail seats, and back.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem_solver/assembly/rail_kinematics.hpp"
#include "fem_solver/linear/sparse_matrix.hpp"
#include "proto/case/rail_seat.hpp"
#include "proto/wire/messages.hpp"

namespace fem {

/// The operator of a list of seats: value (seat, cell, axis) = displacement of the foot's bottom face averaged over the
/// cell's sub-points, component along the seat axis. Rows sum to one per component and reproduce rigid motions, because
/// the sub-points lie symmetrically about the cell's centre and the rail reproduces rigid motions.
class CellOperator {
 public:
  /// Throws proto::Error (bad_data) for a cell that leaves the rail foot.
  CellOperator(const RailKinematics& rail, const std::vector<proto::RailSeat>& seats);

  /// [n values] x [the rail's degrees of freedom]; its transpose takes forces to the rail.
  const SparseMatrix& matrix() const { return matrix_; }

  /// The real operator applied to rigid motions and unit forces, as the handshake wants it.
  std::vector<proto::SeatRegistration> registration(const RailKinematics& rail,
                                                    const std::vector<proto::RailSeat>& seats) const;

 private:
  SparseMatrix matrix_;
};

}  // namespace fem
