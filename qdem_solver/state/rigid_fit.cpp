#include "qdem_solver/state/rigid_fit.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace qdem {

Placement rigid_fit(const Model& model, const State& state, int body, double scale) {
  using Eigen::Matrix3d, Eigen::Vector3d;
  const Template& shape = model.shape(body);
  Vector3d place = Vector3d::Zero(), centre = Vector3d::Zero();
  for (int i = 0; i < shape.n_nodes(); ++i) {
    const double share = shape.node_volumes[i] / shape.volume();
    place += share * state.position(model, body, i);
    centre += share * shape.nodes[i];
  }
  Matrix3d covariance = Matrix3d::Zero();
  for (int i = 0; i < shape.n_nodes(); ++i) {
    const Vector3d arm = shape.node_volumes[i] * (state.position(model, body, i) - place);
    covariance += arm * (shape.nodes[i] - centre).transpose();
  }
  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d v = svd.matrixV().transpose();
  const Vector3d signs(1, 1, (svd.matrixU() * v).determinant() < 0 ? -1 : 1);  // a rotation, not a reflection
  Placement placement;
  placement.rotation = svd.matrixU() * signs.asDiagonal() * v;
  placement.translation = place - placement.rotation * (scale * centre);
  return placement;
}

}  // namespace qdem
