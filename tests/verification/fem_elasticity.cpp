// Patch test of the hexahedra, total mass, rigid motions without force.
#include "fem_solver/assembly/rail_mesh.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_abs;
using tests::near_rel;

fem::RailMesh short_rail() {
  return {fem::rail_section("60E1"), {0.0, 0.1, 0.25, 0.4}, 0.7};
}

Eigen::VectorXd linear_field(const fem::RailMesh& mesh, const Eigen::Matrix3d& gradient) {
  Eigen::VectorXd u(mesh.n_dofs());
  for (int n = 0; n < mesh.n_nodes(); ++n) u.segment<3>(3 * n) = gradient * mesh.nodes()[n];
  return u;
}

Eigen::VectorXd force(const fem::SparseMatrix& lower, const Eigen::VectorXd& u) {
  return lower.selfadjointView<Eigen::Lower>() * u;
}

// A linear displacement is an equilibrium state: no force inside, its energy is volume times energy density, and the
// stress is the material's everywhere.
TEST(Elasticity, patch_test) {
  const auto mesh = short_rail();
  const fem::Material steel;
  const auto k = mesh.solid().stiffness(steel);
  Eigen::Matrix3d gradient;
  gradient << 1e-4, 3e-5, -2e-5, 1e-5, -2e-4, 4e-5, 2.5e-5, -1e-5, 3e-4;
  const Eigen::VectorXd u = linear_field(mesh, gradient), f = force(k, u);

  const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
  const double mu = steel.young / (2 * (1 + steel.poisson));
  const double lambda = 2 * mu * steel.poisson / (1 - 2 * steel.poisson);
  const Eigen::Matrix3d stress = lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2 * mu * strain;
  const double volume = 0.4 * mesh.section().properties().area;
  EXPECT_TRUE(near_rel(u.dot(f), volume * (stress.array() * strain.array()).sum(), 1e-11));

  const Eigen::Matrix3d deviator = stress - stress.trace() / 3 * Eigen::Matrix3d::Identity();
  for (const double s : mesh.solid().von_mises(u, steel)) EXPECT_TRUE(near_rel(s, std::sqrt(1.5) * deviator.norm(), 1e-10));

  // An inner node: middle of the foot's centre block on the plane x = 0.25.
  const auto inner = mesh.interpolation({0.25, 0.7, 0.01195});
  const int node = inner.nodes[std::max_element(inner.weights.begin(), inner.weights.end()) - inner.weights.begin()];
  EXPECT_TRUE(near_abs(f.segment<3>(3 * node).norm() / f.norm(), 0.0, 1e-12));
}

TEST(Elasticity, rigid_motions_are_free_of_force) {
  const auto mesh = short_rail();
  const auto k = mesh.solid().stiffness({});
  Eigen::Matrix3d spin;
  spin << 0, -3, 2, 3, 0, -1, -2, 1, 0;
  const double scale = force(k, linear_field(mesh, Eigen::Matrix3d::Identity())).norm();
  EXPECT_TRUE(near_abs(force(k, linear_field(mesh, spin)).norm() / scale, 0.0, 1e-11));
  EXPECT_TRUE(near_abs(force(k, Eigen::VectorXd::Ones(mesh.n_dofs())).norm() / scale, 0.0, 1e-11));
}

TEST(Elasticity, lumped_volumes_are_positive_and_complete) {
  const auto mesh = short_rail();
  const Eigen::VectorXd volumes = mesh.solid().node_volumes();
  const double area = mesh.section().properties().area;
  EXPECT_GT(volumes.minCoeff(), 0.0);
  EXPECT_TRUE(near_rel(volumes.sum(), 0.4 * area, 1e-12));
  EXPECT_TRUE(near_rel(mesh.end_face_areas().sum(), 2 * area, 1e-12));
  const auto mean = mesh.section_mean(1);
  double height = 0.0;
  for (std::size_t k = 0; k < mean.nodes.size(); ++k) height += mean.weights[k] * mesh.nodes()[mean.nodes[k]][2];
  EXPECT_TRUE(near_rel(height, mesh.section().properties().centroid_height, 1e-10));
}

}  // namespace
