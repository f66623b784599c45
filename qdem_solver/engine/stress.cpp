#include "qdem_solver/engine/stress.hpp"

#include <array>

#include "qdem_solver/engine/cpu/tasks.hpp"
#include "qdem_solver/model/bond_network.hpp"
#include "qdem_solver/physics/quadruple_energy.hpp"

namespace qdem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Positions and velocities of the four particles.
struct Corners {
  std::array<Vector3d, 4> x, v;
};

Corners corners_of(const Model& model, const State& state, int body, int element) {
  Corners corners;
  for (int k = 0; k < 4; ++k) {
    const int node = model.shape(body).tets[element][k];
    corners.x[k] = state.position(model, body, node), corners.v[k] = state.velocity(model, body, node);
  }
  return corners;
}

/// Particles 2, 3, 4 relative to particle 1, as columns.
Matrix3d relative(const std::array<Vector3d, 4>& values) {
  Matrix3d result;
  for (int k = 0; k < 3; ++k) result.col(k) = values[k + 1] - values[0];
  return result;
}

Matrix3d virial_stress(const Model& model, const Corners& corners, int body, int element) {
  const Template& shape = model.shape(body);
  const BondForce<double> force{model.bodies[body].scale, cpu::material_of(model.material(body)).bond};
  const double share = bonds_of(shape).calibration * bond_share(shape, element);
  Matrix3d virial = Matrix3d::Zero();
  for (const auto& [p, q] : tet_edges) {
    const double length = (shape.nodes[shape.tets[element][q]] - shape.nodes[shape.tets[element][p]]).norm();
    const Vector3d dx = corners.x[q] - corners.x[p], dv = corners.v[q] - corners.v[p];
    Vector3d pull;
    force(dx.data(), dv.data(), &length, share, pull.data());
    virial -= pull * dx.transpose();
  }
  return virial / (relative(corners.x).determinant() / 6);
}

}  // namespace

Matrix3d element_stress(const Model& model, const State& state, int body, int element) {
  const Corners corners = corners_of(model, state, body, element);
  const Material& material = model.material(body);
  if (material.interaction == Interaction::bond) return virial_stress(model, corners, body, element);
  const Matrix3d g =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(model.shape(body).gradients[element].data());
  const double scale = model.bodies[body].scale;
  return cauchy_stress(deformation_gradient(relative(corners.x), g, scale),
                       deformation_gradient(relative(corners.v), g, scale), cpu::material_of(material).quadruple);
}

}  // namespace qdem
