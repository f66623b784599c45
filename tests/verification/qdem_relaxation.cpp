// Relaxation with scaled inertia: what it changes, what it must not change, and where it ends.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "proto/error.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/relaxation.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;
using tests::near_abs;

constexpr qdem::Inertia scaled{3.0, 50.0};
constexpr double stretching = 1e6;  ///< size of the accelerations of stretched() [m/s2]

/// Eleven distorted bodies: eight side by side in lanes, three more in another batch.
qdem::Model bodies() {
  auto model = tests::free_bodies(tests::box_template({3, 2, 2}, {0.06, 0.04, 0.04}, 2e-3), tests::rock(), 11);
  for (int i = 0; i < 11; ++i) model.bodies[i].scale = 0.8 + 0.05 * i;
  model.gravity = {1, 2, -9.81};
  qdem::make_batches(model);
  return model;
}

/// Bodies apart from each other, stretched by 0.1 %.
qdem::State stretched(const qdem::Model& model) {
  std::vector<qdem::Placement> places(model.bodies.size());
  for (std::size_t b = 0; b < places.size(); ++b) places[b].translation[0] = 0.2 * static_cast<double>(b);
  qdem::State state = qdem::make_state(model, places);
  for (double& x : state.x) x *= 1.001;
  return state;
}

Vector3d mean_acceleration(const qdem::Model& model, const qdem::State& state, int body) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < model.shape(body).n_nodes(); ++i) {
    sum += model.node_mass(body, i) * qdem::State::gather(model, state.a, body, i);
  }
  return sum / model.body_mass(body);
}

TEST(ScaledInertia, SlowsRigidMotionAndDeformationByTheirFactors) {
  qdem::Model model = bodies();
  qdem::State truth = stretched(model), state = truth;
  qdem::Engine engine(model);
  engine.prepare(truth);
  model.inertia.assign(model.bodies.size(), scaled);
  engine.prepare(state);
  for (int b = 0; b < 11; ++b) {
    for (int i = 0; i < model.shape(b).n_nodes(); ++i) {
      // Elastic forces have neither resultant nor moment: the rigid part is gravity alone.
      const Vector3d deforming = qdem::State::gather(model, truth.a, b, i) - model.gravity;
      const Vector3d expected = model.gravity / scaled.rigid + deforming / scaled.deformation;
      const Vector3d found = qdem::State::gather(model, state.a, b, i);
      EXPECT_TRUE(near_abs((found - expected).norm(), 0.0, 1e-10 * stretching)) << "body " << b << ", node " << i;
    }
  }
}

TEST(ScaledInertia, AHeldBodyKeepsItsFreeMotions) {
  qdem::Model model = tests::free_bodies(tests::box_template({4, 3, 2}, {0.2, 0.15, 0.1}), tests::rock(), 1);
  model.gravity = {1, 2, -9.81};
  qdem::make_batches(model);
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    if (model.shape(0).nodes[i][1] > 1e-9) continue;
    model.fixities.push_back({0, i, 2u});
  }
  model.inertia = {scaled};
  qdem::State state = qdem::make_state(model, {qdem::Placement{}});
  qdem::Engine engine(model);
  engine.prepare(state);
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    const Vector3d a = qdem::State::gather(model, state.a, 0, i);
    // Round-off of the strains is an acceleration of some 1e-9 m/s2 here.
    EXPECT_TRUE(near_abs(a[0], 1.0 / scaled.rigid, 1e-7));
    EXPECT_TRUE(near_abs(a[2], -9.81 / scaled.rigid, 1e-7));
    if (model.shape(0).nodes[i][1] < 1e-9) {
      EXPECT_EQ(a[1], 0.0);
    }
  }
}

TEST(ScaledInertia, WhatRingsInsideABodyDoesNotBrakeIt) {
  qdem::Model model = bodies();
  model.inertia.assign(model.bodies.size(), qdem::Inertia{});
  model.local_damping = 0.7;
  qdem::State state = stretched(model);
  for (int b = 0; b < 11; ++b) {
    for (int i = 0; i < model.shape(b).n_nodes(); ++i) {
      qdem::State::scatter(model, state.v, b, i, 0.01 * model.gravity);
    }
  }
  qdem::Engine engine(model);
  engine.prepare(state);
  for (int b = 0; b < 11; ++b) {
    const Vector3d expected = (1 - model.local_damping) * model.gravity;
    EXPECT_TRUE(near_abs((mean_acceleration(model, state, b) - expected).norm(), 0.0, 1e-6)) << "body " << b;
  }
}

/// Nine cubes on the ground, pressed a little deeper into it than their weight does.
qdem::Model cubes() {
  auto model = tests::free_bodies(tests::box_template({2, 2, 2}, {0.04, 0.04, 0.04}), tests::rock(), 9);
  for (auto& body : model.bodies) body.kind = qdem::BodyKind::stone;
  model.gravity = {0, 0, -9.81};
  model.contact = {1e6, 0.8, 0.2, 0.5, 1e-3};
  model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.5});
  qdem::make_batches(model);
  return model;
}

qdem::State pressed(const qdem::Model& model) {
  std::vector<qdem::Placement> places(9);
  for (int i = 0; i < 9; ++i) places[i].translation = Vector3d(0.1 * i, 0, 1e-3 - 3e-7);
  return qdem::make_state(model, places);
}

std::int64_t relax(qdem::Model& model, qdem::State& state, std::int64_t most) {
  model.local_damping = 0.5;
  qdem::Relaxation relaxation(model, qdem::resting_points, 0.8);
  qdem::Engine engine(model);
  relaxation.begin(engine, state);
  std::int64_t steps = 0;
  do {
    engine.advance(state, relaxation.step(), 50);
    steps += 50;
    relaxation.fit(engine, state);
  } while (steps < most && (engine.unbalanced_ratio(state) > 1e-9 || engine.kinetic_energy(state) > 1e-16));
  return steps;
}

TEST(Relaxation, EndsAtTheRestOfTheTrueBody) {
  qdem::Model model = cubes();
  qdem::State state = pressed(model);
  const auto steps = relax(model, state, 40000);
  EXPECT_LT(steps, 40000);

  // The same with true masses: elasticity limits the step.
  model.inertia.assign(model.bodies.size(), qdem::Inertia{});
  qdem::State truth = pressed(model);
  qdem::Engine engine(model);
  engine.prepare(truth);
  const double dt = 0.8 * qdem::StepBound(model).at(truth, engine.contacts(), qdem::near_gap(model.contact));
  std::int64_t true_steps = 0;
  do {
    engine.advance(truth, dt, 500);
    true_steps += 500;
  } while (true_steps < 400000 && (engine.unbalanced_ratio(truth) > 1e-9 || engine.kinetic_energy(truth) > 1e-16));
  double largest = 0.0;
  for (int b = 0; b < 9; ++b) {
    for (int i = 0; i < 27; ++i) {
      largest = std::max(largest, std::abs(state.position(model, b, i)[2] - truth.position(model, b, i)[2]));
    }
  }
  std::printf("%lld steps of scaled inertia, %lld of true masses; largest difference %.1e m\n",
              static_cast<long long>(steps), static_cast<long long>(true_steps), largest);
  EXPECT_TRUE(near_abs(largest, 0.0, 1e-11));
}

TEST(Relaxation, NeedsItsInertia) {
  // Negative control: at true masses the same step blows up.
  qdem::Model model = cubes();
  qdem::State state = pressed(model);
  qdem::Relaxation relaxation(model, qdem::resting_points, 0.8);
  model.inertia.assign(model.bodies.size(), qdem::Inertia{});
  qdem::Engine engine(model);
  engine.prepare(state);
  EXPECT_THROW(engine.advance(state, relaxation.step(), 5000), proto::Error);
}

}  // namespace
