// Angle of repose: heaps dumped on a plane get steeper with friction, and with rolling friction.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

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

struct Angles {
  double mean = 0.0, error = 0.0;  ///< of single heaps, and its standard error [degrees]
};

Angles angles_of(const qdem::Model& model, const std::string& what, unsigned n_heaps) {
  double sum = 0.0, squares = 0.0;
  for (unsigned seed = 1; seed <= n_heaps; ++seed) {
    const double angle = angle_of(model, seed);
    sum += angle, squares += angle * angle;
  }
  const double mean = sum / n_heaps, variance = (squares - n_heaps * mean * mean) / (n_heaps - 1);
  const Angles angles{mean, std::sqrt(variance / n_heaps)};
  std::cout << what << ": " << angles.mean << " +- " << angles.error << " degrees\n";
  return angles;
}

double joint_error(const Angles& p, const Angles& q) {
  return std::hypot(p.error, q.error);
}

}  // namespace

// Single heaps of so few stones differ by some degrees, so a step of 0.1 in friction is judged by its standard error:
// no mean falls by more than two of them, and from 0.2 to 0.6 they rise by more than four.
TEST(Repose, GrowsWithFriction) {
  std::vector<Angles> all;
  for (const char* friction : {"0.2", "0.3", "0.4", "0.5", "0.6"}) {
    all.push_back(angles_of(octahedra(std::stod(friction)), std::string("friction ") + friction, 6));
    if (all.size() < 2) continue;
    const Angles &last = all.back(), &before = all[all.size() - 2];
    EXPECT_GT(last.mean - before.mean, -2 * joint_error(last, before));
  }
  EXPECT_GT(all.back().mean - all.front().mean, 4 * joint_error(all.back(), all.front()));
}

TEST(Repose, OfSpheresGrowsWithRollingFriction) {
  const Angles without = angles_of(clumps(0.0), "rolling friction 0", 3);
  const Angles with = angles_of(clumps(0.3), "rolling friction 0.3", 3);
  EXPECT_GT(with.mean - without.mean, 4 * joint_error(with, without));
}
