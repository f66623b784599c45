#include "qdem_solver/model/pad_cells.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <sstream>

#include "proto/error.hpp"

namespace qdem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int points_per_side = 4;
constexpr double largest_offset = 2e-3;  ///< of the sleeper's top from the seat's plane [m]
constexpr double rim = 1e-9;             ///< barycentric slack, so that a point on an edge finds a triangle

/// Top triangles of the sleeper in the frame of one seat.
class SleeperTop {
 public:
  SleeperTop(const Model& model, const State& state, int sleeper, const proto::RailSeat& seat)
      : shape_(model.shape(sleeper)) {
    for (int i = 0; i < shape_.n_nodes(); ++i) {
      local_.push_back(seat.axes.transpose() * (state.position(model, sleeper, i) - seat.origin));
    }
    for (int t = 0; t < static_cast<int>(shape_.triangles.size()); ++t) {
      const auto& n = shape_.triangles[t].nodes;
      if ((local_[n[1]] - local_[n[0]]).cross(local_[n[2]] - local_[n[0]])[2] > 0) top_.push_back(t);
    }
    for (int e = 0; e < shape_.n_tets(); ++e) {
      for (int skip = 0; skip < 4; ++skip) tet_of_[face(e, skip)] = e;
    }
  }

  /// Adds weight x the barycentric coordinates of the seat-plane point (p, q); false when nothing lies under it.
  bool add(double p, double q, double weight, std::map<int, double>& weights, double& offset) const {
    int found = -1;
    double highest = 0.0;
    for (const int t : top_) {
      double height;
      if (!height_over(t, p, q, height)) continue;
      if (found < 0 || height > highest) found = t, highest = height;
    }
    if (found < 0) return false;
    offset = highest;
    auto key = shape_.triangles[found].nodes;
    std::sort(key.begin(), key.end());
    const auto& tet = shape_.tets[tet_of_.at(key)];
    Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = local_[tet[k + 1]] - local_[tet[0]];
    const Vector3d part = edges.inverse() * (Vector3d(p, q, 0) - local_[tet[0]]);
    weights[tet[0]] += weight * (1 - part.sum());
    for (int k = 0; k < 3; ++k) weights[tet[k + 1]] += weight * part[k];
    return true;
  }

 private:
  std::array<int, 3> face(int e, int skip) const {
    std::array<int, 3> nodes;
    for (int k = 0, j = 0; k < 4; ++k) {
      if (k != skip) nodes[j++] = shape_.tets[e][k];
    }
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  bool height_over(int t, double p, double q, double& height) const {
    const auto& n = shape_.triangles[t].nodes;
    Eigen::Matrix2d plan;
    plan << local_[n[1]].head<2>() - local_[n[0]].head<2>(), local_[n[2]].head<2>() - local_[n[0]].head<2>();
    const Eigen::Vector2d part = plan.inverse() * (Eigen::Vector2d(p, q) - local_[n[0]].head<2>());
    if (part.minCoeff() < -rim || part.sum() > 1 + rim) return false;
    height = (1 - part.sum()) * local_[n[0]][2] + part[0] * local_[n[1]][2] + part[1] * local_[n[2]][2];
    return true;
  }

  const Template& shape_;
  std::vector<Vector3d> local_;  ///< particles in the seat's frame
  std::vector<int> top_;
  std::map<std::array<int, 3>, int> tet_of_;
};

[[noreturn]] void refuse(const proto::RailSeat& seat, int cell, const std::string& problem, const std::string& advice) {
  throw proto::Error(proto::ExitCode::bad_data, problem, "rail seat '" + seat.name + "', cell " + std::to_string(cell),
                     advice);
}

PadCell make_cell(const SleeperTop& top, const proto::RailSeat& seat, int index) {
  const Vector3d centre = seat.axes.transpose() * (seat.cell_point(index) - seat.origin);
  const double share = 1.0 / (points_per_side * points_per_side);
  std::map<int, double> weights;
  for (int i = 0; i < points_per_side; ++i) {
    for (int j = 0; j < points_per_side; ++j) {
      const double a = (2.0 * i + 1) / points_per_side - 1, b = (2.0 * j + 1) / points_per_side - 1;
      const double p = centre[0] + a * seat.half_lengths[0] / seat.cells[0];
      const double q = centre[1] + b * seat.half_lengths[1] / seat.cells[1];
      double offset = 0.0;
      if (!top.add(p, q, share, weights, offset)) {
        refuse(seat, index, "the pad reaches over the edge of the sleeper's top",
               "check origin_m, half_lengths_m and the sleeper's size");
      }
      if (std::abs(offset) > largest_offset) {
        std::ostringstream text;
        text << "the sleeper's top lies " << 1e3 * offset << " mm off the pad's plane (allowed " << 1e3 * largest_offset
             << " mm)";
        refuse(seat, index, text.str(), "the seat's origin_m must lie on the sleeper's top, z = 0");
      }
    }
  }
  PadCell cell;
  cell.axes = seat.axes;
  for (const auto& [node, weight] : weights) cell.nodes.push_back(node), cell.weights.push_back(weight);
  for (int axis = 0; axis < 3; ++axis) cell.laws[axis] = seat.cell_law(axis);
  return cell;
}

}  // namespace

std::vector<PadCell> make_pad_cells(const Model& model, const State& state, int sleeper,
                                    const std::vector<proto::RailSeat>& seats) {
  std::vector<PadCell> cells;
  for (const proto::RailSeat& seat : seats) {
    const SleeperTop top(model, state, sleeper, seat);
    for (int index = 0; index < seat.n_cells(); ++index) cells.push_back(make_cell(top, seat, index));
  }
  return cells;
}

}  // namespace qdem
