#include "coupler/mapping/patch_map.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <string>

#include "proto/error.hpp"

namespace coupler {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr double least_spread = 0.05;      // of the largest, for a gradient along that direction
constexpr double rank_threshold = 1e-3;    // of the largest pivot of the fit
constexpr double supports_per_radius = 4;  // of the radial functions
constexpr double coincidence = 1e-6;       // of the set's radius
constexpr double carried = 1e-10;          // error of a rigid motion, over the sets' radius

/// Centre, size and principal directions of a point set.
struct Extent {
  Vector3d centre = Vector3d::Zero();
  double radius = 0.0;                     ///< largest distance from the centre [m]
  Matrix3d axes = Matrix3d::Identity();    ///< columns
  bool spread[3] = {false, false, false};  ///< whether the set extends along the column
  double length() const { return radius > 0.0 ? radius : 1.0; }
};

Extent extent_of(const Points& points) {
  Extent extent;
  for (const auto& point : points) extent.centre += point / static_cast<double>(points.size());
  Matrix3d scatter = Matrix3d::Zero();
  for (const auto& point : points) {
    const Vector3d arm = point - extent.centre;
    scatter += arm * arm.transpose();
    extent.radius = std::max(extent.radius, arm.norm());
  }
  if (points.size() == 1 || extent.radius == 0.0) return extent;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(scatter);
  extent.axes = principal.eigenvectors();
  const double largest = principal.eigenvalues()[2];
  for (Index k = 0; k < 3; ++k) extent.spread[k] = principal.eigenvalues()[k] > least_spread * least_spread * largest;
  return extent;
}

/// Basis fields at the points of a set, [3 n][k]: translations; per direction in which the set extends the gradients of
/// all components, a dropped one's with the rotation that goes with it; rotations in planes of dropped directions.
MatrixXd linear_fields(const Points& points, const Extent& extent) {
  MatrixXd fields = MatrixXd::Zero(3 * static_cast<Index>(points.size()), 15);
  Index row = 0, n_fields = 0;
  for (const auto& point : points) {
    const Vector3d arm = extent.axes.transpose() * (point - extent.centre) / extent.length();
    Index column = 0;
    const auto add = [&](const Vector3d& value) { fields.block<3, 1>(row, column++) = extent.axes * value; };
    for (Index k = 0; k < 3; ++k) add(Vector3d::Unit(k));
    for (Index t = 0; t < 3; ++t)
      for (Index e = 0; e < 3; ++e) {
        const Vector3d gradient = Vector3d::Unit(e) * arm[t], turn = Vector3d::Unit(t) * arm[e];
        if (extent.spread[t]) add(extent.spread[e] ? gradient : Vector3d(gradient - turn));
        if (!extent.spread[t] && !extent.spread[e] && t < e) add(gradient - turn);
      }
    row += 3, n_fields = column;
  }
  return fields.leftCols(n_fields);
}

/// Wendland's C2 function of distance over support.
double radial(double distance) {
  const double rest = std::max(0.0, 1.0 - distance);
  return rest * rest * rest * rest * (4.0 * distance + 1.0);
}

void refuse_coincident(const Points& points, double radius) {
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!((points[i] - points[j]).norm() > coincidence * radius))
        throw proto::Error(proto::ExitCode::protocol,
                           "points " + std::to_string(j) + " and " + std::to_string(i) + " lie at the same place", "",
                           "register every point once");
}

/// Weights of `from` at every point of `to`, [n_to][n_from]. Off a plane or a line the nearest place on it counts.
MatrixXd radial_weights(const Points& from, const Points& to, const Extent& extent) {
  const double support = supports_per_radius * extent.length();
  const auto n = static_cast<Index>(from.size());
  MatrixXd own(n, n), other(n, static_cast<Index>(to.size()));
  for (Index j = 0; j < n; ++j)
    for (Index i = 0; i < n; ++i)
      own(i, j) = radial((from[static_cast<std::size_t>(i)] - from[static_cast<std::size_t>(j)]).norm() / support);
  Matrix3d onto = Matrix3d::Zero();
  for (Index k = 0; k < 3; ++k)
    if (extent.spread[k]) onto += extent.axes.col(k) * extent.axes.col(k).transpose();
  for (Index j = 0; j < other.cols(); ++j) {
    const Vector3d place = extent.centre + onto * (to[static_cast<std::size_t>(j)] - extent.centre);
    for (Index i = 0; i < n; ++i) other(i, j) = radial((place - from[static_cast<std::size_t>(i)]).norm() / support);
  }
  return own.ldlt().solve(other).transpose();
}

/// The six rigid motions at the points of a set, [3 n][6]; rotations by one radius at the radius.
MatrixXd rigid_motions(const Points& points, const Extent& extent) {
  MatrixXd motions(3 * static_cast<Index>(points.size()), 6);
  Index row = 0;
  for (const auto& point : points) {
    const Vector3d arm = (point - extent.centre) / extent.length();
    for (Index k = 0; k < 3; ++k) {
      motions.block<3, 1>(row, k) = Vector3d::Unit(k);
      motions.block<3, 1>(row, 3 + k) = Vector3d::Unit(k).cross(arm);
    }
    row += 3;
  }
  return motions;
}

int n_carried(const PatchMap& map, const Points& from, const Points& to, const Extent& extent) {
  const MatrixXd wanted = rigid_motions(to, extent), error = map.matrix * rigid_motions(from, extent) - wanted;
  // Rotations are counted in the set's principal axes: a line's twist is one of them.
  MatrixXd turned = error;
  turned.rightCols(3) = error.rightCols(3) * extent.axes;
  int n = 0;
  for (Index k = 0; k < 6; ++k)
    n += turned.col(k).lpNorm<Eigen::Infinity>() <= carried * (1.0 + wanted.lpNorm<Eigen::Infinity>());
  return n;
}

}  // namespace

PatchMap map_patch(const Points& from, const Points& to) {
  const auto extent = extent_of(from);
  refuse_coincident(from, extent.radius);
  const MatrixXd fields = linear_fields(from, extent);
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> fit;
  fit.setThreshold(rank_threshold);
  fit.compute(fields);
  const MatrixXd fitted = fit.pseudoInverse();
  const MatrixXd rest = MatrixXd::Identity(fields.rows(), fields.rows()) - fields * fitted;
  const MatrixXd weights = radial_weights(from, to, extent);
  PatchMap map;
  map.matrix = linear_fields(to, extent) * fitted;
  for (Index i = 0; i < weights.rows(); ++i)
    for (Index j = 0; j < weights.cols(); ++j)
      map.matrix.middleRows<3>(3 * i) += weights(i, j) * rest.middleRows<3>(3 * j);
  map.n_rigid_motions = n_carried(map, from, to, extent);
  return map;
}

}  // namespace coupler
