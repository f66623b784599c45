// V1 rigid motion and free spin, V2 patch test, V3 identities of the quadruple.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "qdem_solver/engine/cpu/kernels.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/physics/quadruple_energy.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/particle_forces.hpp"
#include "tests/support/tolerance.hpp"

using Eigen::Matrix3d;
using Eigen::Vector3d;
using tests::near_abs;
using tests::near_rel;

namespace {

qdem::Material viscous_rock() {
  qdem::Material material = tests::rock();
  material.lame_viscosity = 4e3, material.shear_viscosity = 7e3;  // not proportional
  return material;
}

Matrix3d some_rotation() {
  return Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

Vector3d momentum(const qdem::Model& model, const qdem::State& state) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) sum += model.node_mass(0, i) * state.velocity(model, 0, i);
  return sum;
}

Vector3d angular_momentum(const qdem::Model& model, const qdem::State& state) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    sum += model.node_mass(0, i) * state.position(model, 0, i).cross(state.velocity(model, 0, i));
  }
  return sum;
}

}  // namespace

TEST(V1, RigidMotionGivesNoForce) {
  const auto model = tests::free_bodies(tests::box_template({3, 2, 2}, {0.06, 0.04, 0.04}, 2e-3), viscous_rock());
  qdem::State state = qdem::make_state(model, {{some_rotation(), {0.3, -0.2, 0.1}}});
  const Vector3d spin(300, -200, 500), speed(3, 4, -5);
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    qdem::State::scatter(model, state.v, 0, i, speed + spin.cross(state.position(model, 0, i)));
  }
  // Scale of a force: the stress that round-off of F makes, E eps, on a face of the mesh; viscosity likewise.
  const double face = 0.02 * 0.02;
  const double round_off = (60e9 + 7e3 * spin.norm()) * 1e-15 * face * 100;
  for (const Vector3d& force : tests::forces(model, state)) EXPECT_LT(force.norm(), round_off);
}

TEST(V1, FreeSpinKeepsMomenta) {
  const auto material = tests::with_retardation(tests::rock(), 1e-7);
  const auto model = tests::free_bodies(tests::box_template({3, 2, 2}, {0.06, 0.04, 0.04}, 2e-3), material);
  qdem::State state = qdem::make_state(model, {{some_rotation(), {0, 0, 0}}});
  const Vector3d spin(200, -100, 300), speed(0.5, 0.2, -0.1);
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    qdem::State::scatter(model, state.v, 0, i, speed + spin.cross(state.position(model, 0, i)));
  }
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  const Vector3d p = momentum(model, state), l = angular_momentum(model, state);
  const double energy = engine.energies(state).kinetic;
  engine.advance(state, 3e-7, 20000);  // more than half a turn
  EXPECT_LT((momentum(model, state) - p).norm(), 1e-10 * p.norm());
  EXPECT_LT((angular_momentum(model, state) - l).norm(), 1e-10 * l.norm());
  const auto end = engine.energies(state);
  const double radius = 0.045, strain_bound = 2700 * spin.squaredNorm() * radius * radius / 60e9;
  EXPECT_TRUE(near_rel(end.kinetic + end.strain, energy, strain_bound));
}

TEST(V2, PatchTestSixStrainStates) {
  const double size = 0.06;
  const auto model = tests::free_bodies(tests::box_template({3, 3, 3}, {size, size, size}, 4e-3), tests::rock());
  const auto& shape = model.shape(0);
  const auto material = qdem::QuadrupleMaterial{model.materials[0].lambda(), model.materials[0].mu(), 0, 0};
  std::vector<char> inner(shape.n_nodes(), 1);
  for (const int node : shape.surface_nodes) inner[node] = 0;
  for (int state_number = 0; state_number < 6; ++state_number) {
    Matrix3d strain = Matrix3d::Zero();
    const int i = state_number < 3 ? state_number : state_number - 3, j = state_number < 3 ? i : (i + 1) % 3;
    strain(i, j) = strain(j, i) = 1e-2;
    const Matrix3d f = some_rotation() * (Matrix3d::Identity() + strain);
    qdem::State state = qdem::make_state(model, {{f, {0, 0, 0}}});
    const Matrix3d stress = qdem::cauchy_stress(f, Matrix3d::Zero(), material);
    const auto force = tests::forces(model, state);
    // Inner nodes are in balance; surface nodes feel minus the traction of the uniform stress.
    std::vector<Vector3d> traction(shape.n_nodes(), Vector3d::Zero());
    for (const auto& triangle : shape.triangles) {
      const auto& n = triangle.nodes;
      const Vector3d x0 = state.position(model, 0, n[0]);
      const Vector3d area = 0.5 * (state.position(model, 0, n[1]) - x0).cross(state.position(model, 0, n[2]) - x0);
      for (const int node : n) traction[node] += stress * area / 3;
    }
    double largest = 0;
    for (const Vector3d& t : traction) largest = std::max(largest, t.norm());
    for (int node = 0; node < shape.n_nodes(); ++node) {
      EXPECT_LT((force[node] + traction[node]).norm(), 1e-12 * largest)
          << "strain state " << state_number << ", node " << node << (inner[node] ? " (inner)" : "");
    }
  }
}

TEST(V3, AreaFormEqualsGradientForm) {
  tests::Mesh mesh{{{0.1, 0.2, 0.3}, {1.2, 0.1, 0.2}, {0.3, 1.1, -0.1}, {0.2, 0.4, 0.9}}, {{0, 1, 2, 3}}};
  const auto model = tests::free_bodies(qdem::make_template("one", mesh.nodes, mesh.tets), viscous_rock());
  Matrix3d f, f_rate;
  f << 1.02, 0.01, -0.03, 0.02, 0.97, 0.04, -0.01, 0.05, 1.01;
  f = some_rotation() * f;
  f_rate << 30, -20, 10, 5, 15, -25, 40, 12, -7;
  qdem::State state = qdem::make_state(model, {{f, {0.5, 0.2, 0.1}}});
  for (int i = 0; i < 4; ++i) qdem::State::scatter(model, state.v, 0, i, f_rate * mesh.nodes[i]);
  const auto& m = model.materials[0];
  const Matrix3d stress = qdem::cauchy_stress(f, f_rate, {m.lambda(), m.mu(), m.lame_viscosity, m.shear_viscosity});
  std::array<Vector3d, 4> x;
  for (int i = 0; i < 4; ++i) x[i] = state.position(model, 0, i);
  const auto force = tests::forces(model, state);
  const double size = force[0].norm();
  Vector3d sum = Vector3d::Zero(), torque = Vector3d::Zero();
  for (int k = 0; k < 4; ++k) {
    const Vector3d &a = x[(k + 1) % 4], &b = x[(k + 2) % 4], &c = x[(k + 3) % 4];
    Vector3d area = 0.5 * (b - a).cross(c - a);
    if (area.dot(x[k] - a) > 0) area = -area;  // outward of the face opposite particle k
    EXPECT_LT((force[k] - stress * area / 3).norm(), 1e-13 * size) << "particle " << k;
    sum += force[k], torque += x[k].cross(force[k]);
  }
  EXPECT_LT(sum.norm(), 1e-14 * size);
  EXPECT_LT(torque.norm(), 1e-14 * size);
}
