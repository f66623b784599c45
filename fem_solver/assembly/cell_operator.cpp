#include "fem_solver/assembly/cell_operator.hpp"

#include <Eigen/Geometry>

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

// Nodal field of a rigid motion about `centre`: 0-2 unit translations, 3-5 unit rotations.
Eigen::VectorXd rigid_motion(const RailMesh& mesh, int mode, const Eigen::Vector3d& centre) {
  Eigen::VectorXd field(mesh.n_dofs());
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(mode % 3);
  for (int n = 0; n < mesh.n_nodes(); ++n)
    field.segment<3>(3 * n) = mode < 3 ? axis : Eigen::Vector3d(axis.cross(mesh.nodes()[n] - centre));
  return field;
}

}  // namespace

CellOperator::CellOperator(const RailMesh& mesh, const std::vector<proto::RailSeat>& seats) {
  std::vector<Eigen::Triplet<double>> entries;
  int value = 0;
  for (const auto& seat : seats)
    for (int cell = 0; cell < seat.n_cells(); ++cell, value += 3)
      for (const auto& point : sub_points(seat, cell)) {
        const NodeWeights row = mesh.interpolation(point);
        for (std::size_t k = 0; k < row.nodes.size(); ++k)
          for (int axis = 0; axis < 3; ++axis)
            for (int c = 0; c < 3; ++c)
              if (seat.axes(c, axis) != 0.0)
                entries.emplace_back(value + axis, 3 * row.nodes[k] + c,
                                     seat.axes(c, axis) * row.weights[k] / (n_sub * n_sub));
      }
  matrix_.resize(value, mesh.n_dofs());
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

std::vector<proto::SeatRegistration> CellOperator::registration(const RailMesh& mesh,
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
    Eigen::MatrixXd response(n, 6);
    for (int mode = 0; mode < 6; ++mode)
      response.col(mode) = (matrix_ * rigid_motion(mesh, mode, seat.origin)).segment(first, n);
    for (int mode = 0; mode < 6; ++mode)
      for (int i = 0; i < n; ++i) r.rigid_response.push_back(response(i, mode));
    for (int i = 0; i < n; ++i) {
      const Eigen::VectorXd nodal = matrix_.transpose() * Eigen::VectorXd::Unit(matrix_.rows(), first + i);
      Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
      for (int node = 0; node < mesh.n_nodes(); ++node) {
        const Eigen::Vector3d f = nodal.segment<3>(3 * node);
        force += f, moment += (mesh.nodes()[node] - seat.origin).cross(f);
      }
      r.force_resultants.insert(r.force_resultants.end(),
                                {force[0], force[1], force[2], moment[0], moment[1], moment[2]});
    }
    all.push_back(std::move(r));
    first += n;
  }
  return all;
}

}  // namespace fem
