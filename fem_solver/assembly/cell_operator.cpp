#include "fem_solver/assembly/cell_operator.hpp"

namespace fem {
namespace {

constexpr int n_sub = 4;  // sub-points along each side of a cell, at the middle of equal parts

std::vector<Eigen::Vector3d> sub_points(const proto::RailSeat& seat, int cell) {
  const Eigen::Vector2d size(2 * seat.half_lengths[0] / seat.cells[0], 2 * seat.half_lengths[1] / seat.cells[1]);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < n_sub; ++i)
    for (int j = 0; j < n_sub; ++j)
      points.push_back(seat.cell_point(cell) + seat.axes.col(0) * size[0] * ((i + 0.5) / n_sub - 0.5) +
                       seat.axes.col(1) * size[1] * ((j + 0.5) / n_sub - 0.5));
  return points;
}

}  // namespace

CellOperator::CellOperator(const RailKinematics& rail, const std::vector<proto::RailSeat>& seats) {
  std::vector<Eigen::Triplet<double>> entries;
  int value = 0;
  for (const auto& seat : seats)
    for (int cell = 0; cell < seat.n_cells(); ++cell, value += 3)
      for (const auto& point : sub_points(seat, cell))
        for (const auto& [component, dof, weight] : rail.motion_at(point))
          for (int axis = 0; axis < 3; ++axis)
            if (seat.axes(component, axis) != 0.0)
              entries.emplace_back(value + axis, dof, seat.axes(component, axis) * weight / (n_sub * n_sub));
  matrix_.resize(value, rail.n_dofs());
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

std::vector<proto::SeatRegistration> CellOperator::registration(const RailKinematics& rail,
                                                                const std::vector<proto::RailSeat>& seats) const {
  std::vector<proto::SeatRegistration> all;
  int first = 0;
  for (const auto& seat : seats) {
    const int n = 3 * seat.n_cells();
    proto::SeatRegistration r;
    r.name = seat.name;
    for (int cell = 0; cell < seat.n_cells(); ++cell) {
      const Eigen::Vector3d p = seat.cell_point(cell);
      r.points.insert(r.points.end(), {p[0], p[1], p[2]});
      r.weights.push_back(seat.cell_weight());
    }
    const Eigen::MatrixXd rigid = rail.rigid_motions(seat.origin);
    const Eigen::MatrixXd response = (matrix_ * rigid).middleRows(first, n);
    for (int mode = 0; mode < 6; ++mode)
      for (int i = 0; i < n; ++i) r.rigid_response.push_back(response(i, mode));
    for (int i = 0; i < n; ++i) {
      const Eigen::VectorXd load = matrix_.transpose() * Eigen::VectorXd::Unit(matrix_.rows(), first + i);
      const Eigen::VectorXd resultant = rigid.transpose() * load;
      r.force_resultants.insert(r.force_resultants.end(), resultant.data(), resultant.data() + 6);
    }
    all.push_back(std::move(r));
    first += n;
  }
  return all;
}

}  // namespace fem
