// Blocks at rest on each other stay where they are: in a second they move by less than a millionth of the overlap that
// their weight makes. Sticking contacts are springs with memory, so nothing but round-off may move them.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;

constexpr int n_blocks = 4;
constexpr double rounding = 1e-3, gravity = 9.81, height = 0.03, ground_friction = 0.5;

/// Blocks that get smaller upward, each turned and shifted against the one below.
struct Stack {
  Stack() : model(tests::free_bodies(tests::box_template({2, 2, 1}, {0.09, 0.08, height}), soft_rock(), n_blocks)) {
    model.contact = {3e4, 0.8, 0.1, 0.5, rounding};
    model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, ground_friction});
    model.gravity = {0, 0, -gravity};
    std::vector<qdem::Placement> places;
    double top = -rounding;
    for (int b = 0; b < n_blocks; ++b) {
      const double scale = 1 - 0.15 * b;
      model.bodies[b].scale = scale;
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.3 * b, Vector3d::UnitZ()).toRotationMatrix();
      const Vector3d bottom(0.003 * b, -0.002 * b, top + 2 * rounding);
      places.push_back({turn, bottom - turn * (scale * Vector3d(0.045, 0.04, 0))});
      top += 2 * rounding + scale * height;
    }
    qdem::make_batches(model);
    state = qdem::make_state(model, places);
  }

  static qdem::Material soft_rock() {
    auto material = tests::rock();
    material.young = 1e9;
    return tests::with_retardation(material, 1e-5);
  }

  qdem::Model model;
  qdem::State state;
};

double largest_distance(const std::vector<double>& p, const std::vector<double>& q) {
  double largest = 0;
  for (std::size_t i = 0; i < p.size(); ++i) largest = std::max(largest, std::abs(p[i] - q[i]));
  return largest;
}

}  // namespace

TEST(Stack, BlocksAtRestDoNotCreep) {
  Stack stack;
  qdem::Engine engine(stack.model, {1});
  engine.prepare(stack.state);
  const double dt = 0.8 * qdem::StepBound(stack.model).at(stack.state, engine.contacts(), rounding);
  const auto run = [&](double time) { engine.advance(stack.state, dt, std::llround(time / dt)); };
  run(1.5);
  const auto settled = stack.state.x;
  run(1.0);
  const double creep = largest_distance(stack.state.x, settled);
  const auto report = engine.contacts().report(stack.state);
  std::cout << "moved by " << creep << " m in 1 s, unbalanced " << engine.unbalanced_ratio(stack.state) << ", contacts "
            << report.live << ", deepest " << report.largest_penetration << " m, step " << dt << " s\n";
  EXPECT_GT(report.live, 4 * n_blocks);
  EXPECT_LT(creep, 1e-6 * report.largest_penetration);
}
