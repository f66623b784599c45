// V14: a block that slides over another one without friction keeps its speed: facets are no bumps.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;

constexpr double rounding = 1e-3, gravity = 9.81, height = 0.02;

/// A block on a larger base that is held at its bottom; neither their facets nor their edges are aligned.
struct Sledge {
  Sledge() : model(tests::free_bodies(tests::box_template({8, 5, 1}, {0.16, 0.1, height}), soft_rock(), 2)) {
    model.templates.push_back(tests::box_template({3, 3, 1}, {0.05, 0.04, height}));
    model.bodies[1].template_id = 1;
    model.contact = {1e5, 0.8, 0.3, 0.0, rounding};
    model.gravity = {0, 0, -gravity};
    qdem::make_batches(model);
    for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
      if (model.shape(0).nodes[i][2] == 0) model.fixities.push_back({0, i, 7u});
    }
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.2, Vector3d::UnitZ()).toRotationMatrix();
    state = qdem::make_state(model, {{}, {turn, {0.02, 0.03, height + 2 * rounding}}});
  }

  static qdem::Material soft_rock() {
    auto material = tests::rock();
    material.young = 1e9;
    return material;
  }
  /// Of the contacts on the block [N].
  Vector3d force(const qdem::Engine& engine) const {
    std::vector<double> forces(state.x.size(), 0.0);
    engine.contacts().gather(1, forces);
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < model.shape(1).n_nodes(); ++i) sum += qdem::State::gather(model, forces, 1, i);
    return sum;
  }
  double weight() const { return model.body_mass(1) * gravity; }

  qdem::Model model;
  qdem::State state;
};

}  // namespace

TEST(V14, FacetsGiveNoFriction) {
  Sledge sledge;
  qdem::Engine engine(sledge.model, {1});
  engine.prepare(sledge.state);
  const double dt = 0.5 * qdem::StepBound(sledge.model).at(sledge.state, engine.contacts(), rounding);
  engine.advance(sledge.state, dt, std::llround(0.1 / dt));
  const Vector3d speed(0.2, 0, 0);
  for (int i = 0; i < sledge.model.shape(1).n_nodes(); ++i) {
    const Vector3d v = sledge.state.velocity(sledge.model, 1, i);
    qdem::State::scatter(sledge.model, sledge.state.v, 1, i, v + speed);
  }
  const double duration = 0.3;  // 60 mm: three facets
  const int samples = 3000;
  double mean = 0, largest = 0;
  for (int i = 0; i < samples; ++i) {
    engine.advance(sledge.state, dt, std::max<std::int64_t>(1, std::llround(duration / samples / dt)));
    const Vector3d force = sledge.force(engine);
    mean += force[0] / sledge.weight() / samples;
    largest = std::max(largest, force.head<2>().norm() / sledge.weight());
  }
  std::cout << "horizontal force over weight: mean " << mean << ", largest " << largest << "\n";
  EXPECT_LT(std::abs(mean), 0.02);
  EXPECT_LT(largest, 0.02);
}
