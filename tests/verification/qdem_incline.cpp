// V13: a block on an incline slips at atan(mu) and then slides with a = g (sin - mu cos).
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

using Eigen::Vector3d;
using tests::near_rel;

namespace {

constexpr double mu = 0.5, g = 9.81, rounding = 1e-3;

/// A flat elastic block on a plane; the incline is a turned gravity.
class BlockOnPlane {
 public:
  BlockOnPlane() : model_(block()), state_(qdem::make_state(model_, {place()})), engine_(model_, {1}) {
    engine_.prepare(state_);
    dt_ = 0.5 * qdem::StepBound(model_).at(state_, engine_.contacts(), qdem::near_gap(model_.contact));
    run(0.05);
  }

  /// Tilts by small steps, slowly against the block's own vibration.
  void tilt(double angle) {
    for (int i = 1; i <= 100; ++i) set_angle(angle * i / 100), run(1e-3);
  }
  void run(double time) { engine_.advance(state_, dt_, static_cast<std::int64_t>(time / dt_)); }
  double time() const { return state_.time; }
  double sliding_speed() const {
    double momentum = 0;
    for (int i = 0; i < model_.shape(0).n_nodes(); ++i) {
      momentum += model_.node_mass(0, i) * state_.velocity(model_, 0, i)[0];
    }
    return momentum / model_.body_mass(0);
  }

 private:
  static qdem::Placement place() {
    qdem::Placement placement;
    placement.translation = Vector3d(0, 0, rounding);
    return placement;
  }
  static qdem::Model block() {
    auto material = tests::rock();
    material.young = 1e8;
    auto model = tests::free_bodies(tests::box_template({4, 4, 2}, {0.12, 0.1, 0.04}), material);
    model.contact = {1e5, 0.8, 0.3, 0.1, rounding};
    model.planes.push_back({"incline", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, mu});
    model.gravity = {0, 0, -g};
    return model;
  }
  void set_angle(double angle) { model_.gravity = {g * std::sin(angle), 0, -g * std::cos(angle)}; }

  qdem::Model model_;
  qdem::State state_;
  qdem::Engine engine_;
  double dt_ = 0.0;
};

}  // namespace

TEST(V13, SlipsAtTheAngleOfFriction) {
  const double below = std::atan(mu * 0.995), above = std::atan(mu * 1.005);
  BlockOnPlane held, sliding;
  held.tilt(below), held.run(0.2);
  sliding.tilt(above), sliding.run(0.2);
  const double expected = 0.2 * g * (std::sin(above) - mu * std::cos(above));
  std::cout << "speed 0.5 % below " << held.sliding_speed() << " m/s, above " << sliding.sliding_speed() << " m/s ("
            << expected << " expected)\n";
  EXPECT_LT(std::abs(held.sliding_speed()), 1e-3 * expected);
  EXPECT_GT(sliding.sliding_speed(), 0.7 * expected);
}

TEST(V13, SlidesWithTheRightAcceleration) {
  for (const double degrees : {30.0, 40.0}) {
    const double angle = degrees * M_PI / 180;
    BlockOnPlane block;
    block.tilt(angle), block.run(0.05);
    const double v0 = block.sliding_speed(), t0 = block.time();
    block.run(0.2);
    const double found = (block.sliding_speed() - v0) / (block.time() - t0);
    std::cout << degrees << " deg: a = " << found << " m/s2\n";
    EXPECT_TRUE(near_rel(found, g * (std::sin(angle) - mu * std::cos(angle)), 0.005));
  }
}
