// Angle of repose: heaps dumped on a plane get steeper with friction, and with rolling friction.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/ball_mesh.hpp"
#include "tests/support/heap.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;

constexpr int n_stones = 125, columns = 5;
constexpr double drag = 8.0;                  ///< [1/s]: they land at 1.2 m/s
constexpr double rest = 5e-3, longest = 4.0;  ///< [m/s], [s]

/// Soft rock, so that steps are long: the lowest stones overlap by under 2 % of their size.
qdem::Material soft_rock() {
  auto material = tests::rock();
  material.young = 2e7;
  return tests::with_retardation(material, 2e-5);
}

qdem::Model stones(qdem::Template shape, double friction) {
  auto model = tests::free_bodies(std::move(shape), soft_rock(), n_stones);
  for (auto& body : model.bodies) body.kind = qdem::BodyKind::stone;
  model.contact = {4e3, 0.8, 0.05, friction, 1e-3};
  model.contact.skin = 8e-3;  // a list lives while they fall by 4 mm
  model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, friction});
  model.gravity = {0, 0, -9.81};
  model.drag_per_s = drag;
  return model;
}

/// Octahedra with half axes of 30, 25 and 20 mm.
qdem::Model octahedra(double friction) {
  tests::Mesh mesh = tests::ball_mesh(1, 1.0);
  for (auto& node : mesh.nodes) node = node.cwiseProduct(Vector3d(0.030, 0.025, 0.020));
  return stones(qdem::make_template("octahedron", mesh.nodes, mesh.tets), friction);
}

/// Clumps of six spheres of 20 mm, 8 mm from the centre: nearly balls.
qdem::Model clumps(double rolling_friction) {
  const tests::Mesh mesh = tests::ball_mesh(1, 0.008);
  auto model = stones(qdem::make_template("clump", mesh.nodes, mesh.tets), 0.5);
  model.materials[0].density *= 40;  // the mesh fills a small part of the spheres
  model.contact.shape = qdem::ContactShape::sphere;
  model.contact.rounding = 20e-3;
  model.contact.rolling_friction = rolling_friction;
  return model;
}

double angle_of(const qdem::Model& model, unsigned seed) {
  std::mt19937_64 random(seed);
  qdem::State state = qdem::make_state(model, tests::loose_column(n_stones, columns, 0.066, random));
  qdem::Engine engine(model, {1});
  tests::dump(model, state, engine, rest, longest);
  EXPECT_LT(state.time, longest) << "not at rest";
  const double angle = tests::heap_angle(model, state, engine.contacts());
  std::cout << "  " << angle << " degrees at rest after " << state.time << " s, " << state.step
            << " steps, penetration " << 1e3 * engine.contacts().report(state).largest_penetration << " mm\n";
  return angle;
}

double mean_angle(const qdem::Model& model, unsigned n_heaps) {
  double sum = 0.0;
  for (unsigned seed = 1; seed <= n_heaps; ++seed) sum += angle_of(model, seed);
  return sum / n_heaps;
}

}  // namespace

TEST(Repose, GrowsWithFriction) {
  double last = 0.0;
  for (const double friction : {0.2, 0.3, 0.4, 0.5, 0.6}) {
    const double angle = mean_angle(octahedra(friction), 3);
    std::cout << "friction " << friction << ": " << angle << " degrees\n";
    EXPECT_GT(angle, last);
    last = angle;
  }
}

TEST(Repose, OfSpheresGrowsWithRollingFriction) {
  double last = 0.0;
  for (const double rolling : {0.0, 0.3}) {
    const double angle = mean_angle(clumps(rolling), 1);
    std::cout << "rolling friction " << rolling << ": " << angle << " degrees\n";
    EXPECT_GT(angle, last);
    last = angle;
  }
}
