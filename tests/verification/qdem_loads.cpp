// Loads on patches against closed forms: drop weight, impulse, prescribed displacement.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "proto/error.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;
using tests::near_abs;
using tests::near_rel;

const Vector3d size{0.1, 0.1, 0.2};

/// A block of rock with a load on its top, downward.
class LoadedBlock {
 public:
  LoadedBlock(const qdem::PatchLoad& load, double poisson = 0.25, double gravity = 0.0)
      : model_(tests::free_bodies(tests::box_template({2, 2, 4}, size), tests::rock())) {
    model_.materials[0].poisson = poisson;
    model_.gravity = {0, 0, -gravity};
    state_ = qdem::make_state(model_, {{}});
    model_.loads = {load};
    model_.loads[0].patch = qdem::make_patch(model_, state_, 0, top(), {0, 0, -2});
  }
  static qdem::Region top() {
    qdem::Region region;
    region.centre = {0.05, 0.05, 0.2}, region.half_lengths = {0.06, 0.06, 1e-3};
    return region;
  }
  void hold(double below) {
    for (int i = 0; i < model_.shape(0).n_nodes(); ++i) {
      if (model_.shape(0).nodes[i][2] < below) model_.fixities.push_back({0, i, 7u});
    }
  }
  void start() {
    engine_ = std::make_unique<qdem::Engine>(model_, qdem::EngineOptions{1, {}, 1});
    engine_->prepare(state_);
    engine_->open_ledger(state_);
    step_ = qdem::StepBound(model_).at(state_, engine_->contacts(), 1e-4);
  }
  void advance(double dt) { engine_->advance(state_, dt, 1); }
  double momentum() const {
    double sum = 0.0;
    for (int i = 0; i < model_.shape(0).n_nodes(); ++i) {
      sum -= model_.node_mass(0, i) * state_.velocity(model_, 0, i)[2];
    }
    return sum;
  }
  qdem::EnergyBalance balance() const { return engine_->balance(state_); }
  const qdem::LoadState& load() const { return state_.loads[0]; }
  const qdem::State& state() const { return state_; }
  qdem::Model& model() { return model_; }
  double step() const { return step_; }

 private:
  qdem::Model model_;
  qdem::State state_;
  std::unique_ptr<qdem::Engine> engine_;
  double step_ = 0.0;
};

qdem::PatchLoad drop_weight(double mass, double speed, double stiffness, double damping = 0.0) {
  qdem::PatchLoad load;
  load.kind = qdem::LoadKind::drop_weight;
  load.mass = mass, load.speed = speed, load.stiffness = stiffness, load.damping = damping;
  return load;
}

}  // namespace

TEST(Patch, SharesItsAreaAmongItsParticles) {
  LoadedBlock block(drop_weight(1, 1, 1));
  const qdem::Patch& patch = block.model().loads[0].patch;
  EXPECT_EQ(patch.nodes.size(), 9u);
  double sum = 0.0;
  Vector3d centre = Vector3d::Zero();
  for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
    sum += patch.weights[i];
    centre += patch.weights[i] * block.model().shape(0).nodes[patch.nodes[i]];
  }
  EXPECT_TRUE(near_abs(sum, 1.0, 1e-14));
  EXPECT_TRUE(near_abs((centre - Vector3d(0.05, 0.05, 0.2)).norm(), 0.0, 1e-14));
  EXPECT_TRUE(near_abs(patch.direction[2], -1.0, 1e-15));
  qdem::Region ball;
  ball.centre = {0, 0, 0.2}, ball.radius = 0.08;
  EXPECT_EQ(qdem::make_patch(block.model(), block.state(), 0, ball, {0, 0, -1}).nodes.size(), 7u);
  ball.centre = {0, 0, 0.4};
  try {
    qdem::make_patch(block.model(), block.state(), 0, ball, {0, 0, -1});
    FAIL() << "a patch in the air was accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::bad_data);
    EXPECT_NE(std::string(error.what()).find("body 0"), std::string::npos) << error.what();
  }
}

TEST(DropWeight, OnWhatDoesNotMove) {
  // x = v/w sin wt + g/w^2 (1 - cos wt), w^2 = k/M: F = M g + sqrt((M g)^2 + k M v^2) at most; the touch ends at
  // t = 2 (pi - atan(v w/g))/w.
  const double mass = 20, speed = 0.5, stiffness = 2e7, gravity = 9.81;
  LoadedBlock block(drop_weight(mass, speed, stiffness), 0.25, gravity);
  block.hold(1.0);
  block.start();
  const double omega = std::sqrt(stiffness / mass), dt = 0.01 / omega;
  double peak = 0.0, end = 0.0;
  while (block.state().time < 4 / omega) {
    block.advance(dt);
    peak = std::max(peak, block.load().force);
    if (block.load().force > 0) end = block.state().time;
  }
  const double weight = mass * gravity;
  const double exact_peak = weight + std::sqrt(weight * weight + stiffness * mass * speed * speed);
  const double exact_end = 2 * (M_PI - std::atan(speed * omega / gravity)) / omega;
  std::printf("peak %.6g of %.6g N, touch %.6g of %.6g s\n", peak, exact_peak, end, exact_end);
  EXPECT_TRUE(near_rel(peak, exact_peak, 1e-4));
  EXPECT_TRUE(near_rel(end, exact_end, 0.005));
  EXPECT_TRUE(near_abs(block.balance().work, 0.0, 1e-12)) << "what is held takes no work";
}

TEST(DropWeight, OnAFreeBlockKeepsMomentumAndEnergy) {
  // Two masses that meet through a soft spring exchange velocities as rigid bodies do.
  const double mass = 3, speed = 0.5, stiffness = 1e6;
  LoadedBlock block(drop_weight(mass, speed, stiffness));
  block.start();
  const double body = block.model().body_mass(0), dt = 0.2 * block.step();
  const double touch = M_PI * std::sqrt(mass * body / (mass + body) / stiffness);
  while (block.state().time < 1.2 * touch) {
    block.advance(dt);
    ASSERT_TRUE(near_rel(mass * block.load().velocity + block.momentum(), mass * speed, 1e-4));
  }
  EXPECT_EQ(block.load().force, 0.0);
  EXPECT_TRUE(near_rel(mass * block.load().velocity + block.momentum(), mass * speed, 1e-10));
  const double after = 2 * mass / (mass + body) * speed;
  EXPECT_TRUE(near_rel(block.momentum() / body, after, 1e-3));
  const auto balance = block.balance();
  EXPECT_TRUE(near_rel(balance.work, 0.5 * body * after * after, 2e-3));
  EXPECT_TRUE(near_abs(balance.relative(), 0.0, 1e-4));
}

TEST(DropWeight, ItsBufferHasARestitution) {
  // max(0, k x + c x'): the force ends before the overlap does (contact_restitution.cpp).
  const double mass = 5, speed = 0.4, stiffness = 1e7, zeta = 0.2;
  LoadedBlock block(drop_weight(mass, speed, stiffness, 2 * zeta * std::sqrt(mass * stiffness)));
  block.hold(1.0);
  block.start();
  const double omega = std::sqrt(stiffness / mass), phi = std::asin(zeta);
  while (block.state().time < 4 / omega) block.advance(0.005 / omega);
  EXPECT_TRUE(near_rel(-block.load().velocity / speed, std::exp(-std::tan(phi) * (M_PI - 2 * phi)), 0.002));
}

TEST(DropWeight, WaitsForItsStart) {
  auto load = drop_weight(5, 0.4, 1e7);
  load.start = 1e-4;
  LoadedBlock block(load);
  block.hold(1.0);
  block.start();
  while (block.state().time < 0.99e-4) block.advance(1e-6);
  EXPECT_EQ(block.load().force, 0.0);
  block.advance(1e-5);
  EXPECT_GT(block.load().force, 0.0);
}

TEST(DropWeight, CountsInTheStepBound) {
  LoadedBlock soft(drop_weight(5, 0.4, 1e7)), stiff(drop_weight(5, 0.4, 1e12)), light(drop_weight(1e-9, 0.4, 1e7));
  soft.start(), stiff.start(), light.start();
  EXPECT_LT(stiff.step(), 0.2 * soft.step());
  EXPECT_TRUE(near_rel(light.step(), 2 / std::sqrt(2 * 1e7 / 1e-9), 1e-9));
}

TEST(PatchForce, ImpulseIsMomentum) {
  const double peak = 1e4, duration = 5e-4;
  qdem::PatchLoad load;
  load.history = [&](double t) { return t < duration ? peak * std::sin(M_PI * t / duration) : 0.0; };
  LoadedBlock block(load);
  block.start();
  const double dt = duration / std::ceil(duration / (0.5 * block.step()));
  while (block.state().time < 1.5 * duration) block.advance(dt);
  EXPECT_TRUE(near_rel(block.momentum(), 2 / M_PI * peak * duration, 1e-4));
  const auto balance = block.balance();
  EXPECT_GT(balance.work, 0.5 * std::pow(block.momentum(), 2) / block.model().body_mass(0));
  EXPECT_TRUE(near_abs(balance.relative(), 0.0, 1e-4));
}

TEST(PatchDisplacement, OfABarThroughASpring) {
  // Bar and spring in a row: F = h/(1/k + L/(E A)).
  const double stiffness = 1e9, wanted = 1e-5;
  qdem::PatchLoad load;
  load.kind = qdem::LoadKind::displacement, load.stiffness = stiffness;
  load.history = [&](double) { return wanted; };
  LoadedBlock block(load, 0.0);
  block.hold(1e-6);
  block.model().drag_per_s = 4e4;
  block.start();
  while (block.state().time < 2e-3) block.advance(0.5 * block.step());
  const double force = wanted / (1 / stiffness + size[2] / (60e9 * size[0] * size[1]));
  EXPECT_TRUE(near_rel(block.load().force, force, 1e-4));
  EXPECT_TRUE(near_rel(block.load().path, wanted - force / stiffness, 1e-4));
}
