// Rebound of a body that meets a plane, or another body, in one point through its centre line.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using tests::near_rel;

/// Of the law F = max(0, k d - c v), c = 2 zeta sqrt(m k). The force ends where k d = c v, before the overlap does:
/// at omega t = pi - 2 asin(zeta) (Schwager and Poeschel, Granular Matter 9 (2007) 465). With zeta = sin(phi) the
/// velocity there is -v exp(-tan(phi) (pi - 2 phi)).
double restitution(double zeta) {
  const double phi = std::asin(zeta);
  return std::exp(-std::tan(phi) * (M_PI - 2 * phi));
}

/// Of a force that also pulls, until the overlap ends.
double textbook_restitution(double zeta) {
  return std::exp(-M_PI * zeta / std::sqrt(1 - zeta * zeta));
}

constexpr double edge = 0.04, rounding = 1e-3, speed = 0.1;

/// Cubes of one brick, stiff against their contact (E h = 2.4e9 N/m): vibration takes nothing from the rebound.
qdem::Model cubes(int n, double zeta) {
  const auto cube = tests::box_template({1, 1, 1}, Vector3d::Constant(edge));
  auto model = tests::free_bodies(cube, tests::rock(), n);
  model.contact = {1e5, 0.8, zeta, 0.0, rounding};
  return model;
}

qdem::Model cubes_with_spheres(int n, double zeta) {
  auto model = cubes(n, zeta);
  model.contact.shape = qdem::ContactShape::sphere;
  return model;
}

/// A cube on the vertex at its own origin, the opposite one straight above, which comes to lie `height` above z = 0.
qdem::Placement on_vertex(double height) {
  const Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::Ones(), Vector3d::UnitZ()).toRotationMatrix();
  return {turn, {0, 0, height}};
}

Vector3d mean_velocity(const qdem::Model& model, const qdem::State& state, int body) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < model.shape(body).n_nodes(); ++i) {
    sum += model.node_mass(body, i) * state.velocity(model, body, i);
  }
  return sum / model.body_mass(body);
}

/// Body 0 flies down at `speed` onto what is below it; returns how fast the two part over how fast they met.
double rebound(const qdem::Model& model, const std::vector<qdem::Placement>& places) {
  qdem::State state = qdem::make_state(model, places);
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) qdem::State::scatter(model, state.v, 0, i, {0, 0, -speed});
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  const double dt = 0.2 * qdem::StepBound(model).at(state, engine.contacts(), rounding);
  const double duration = 3 * M_PI * std::sqrt(model.body_mass(0) / model.contact.normal_stiffness);
  engine.advance(state, dt, std::llround(duration / dt));
  EXPECT_EQ(engine.contacts().report(state).live, 0);
  Vector3d parting = mean_velocity(model, state, 0);
  if (model.bodies.size() > 1) parting -= mean_velocity(model, state, 1);
  EXPECT_LT(parting.head<2>().norm(), 1e-6 * speed) << "not through the centre line";
  return parting[2] / speed;
}

void expect_restitution(double found, double zeta) {
  std::cout << "zeta " << zeta << ": e = " << found << ", exact " << restitution(zeta) << ", textbook "
            << textbook_restitution(zeta) << "\n";
  EXPECT_TRUE(near_rel(found, restitution(zeta), 0.01));
}

constexpr double ratios[] = {0.0, 0.03, 0.1, 0.3, 0.7};

}  // namespace

TEST(Restitution, VertexOnAPlane) {
  for (const double zeta : ratios) {
    auto model = cubes(1, zeta);
    model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.0});
    expect_restitution(rebound(model, {on_vertex(rounding * 1.05)}), zeta);
  }
}

TEST(Restitution, VertexOnTheFaceOfAHeavierBody) {
  for (const double zeta : ratios) {
    auto model = cubes(2, zeta);
    model.bodies[1].scale = 1.5;
    qdem::make_batches(model);
    const double half = 0.5 * 1.5 * edge;
    const qdem::Placement below{Matrix3d::Identity(), {-half, -half, -2 * half}};
    expect_restitution(rebound(model, {on_vertex(2.05 * rounding), below}), zeta);
  }
}

TEST(Restitution, SphereOnAPlane) {
  for (const double zeta : ratios) {
    auto model = cubes_with_spheres(1, zeta);
    model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.0});
    expect_restitution(rebound(model, {on_vertex(rounding * 1.05)}), zeta);
  }
}

TEST(Restitution, SphereOnTheSphereOfAHeavierBody) {
  for (const double zeta : ratios) {
    auto model = cubes_with_spheres(2, zeta);
    model.bodies[1].scale = 1.5;
    qdem::make_batches(model);
    const double diagonal = 1.5 * edge * std::sqrt(3.0);
    expect_restitution(rebound(model, {on_vertex(2.05 * rounding), on_vertex(-diagonal)}), zeta);
  }
}
