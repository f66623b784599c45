// The energy ledger: every flow against a closed form, the residual against the step, and against energy that is
// smuggled in.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/particle_forces.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using tests::near_abs;
using tests::near_rel;

constexpr double rounding = 1e-3;

void set_velocity(const qdem::Model& model, qdem::State& state, int body, const Vector3d& velocity) {
  for (int i = 0; i < model.shape(body).n_nodes(); ++i) qdem::State::scatter(model, state.v, body, i, velocity);
}

void print(const char* name, const qdem::EnergyBalance& b) {
  std::printf(
      "%s: work %.6e, kinetic %.3e, strain %.3e, contact %.3e, gravity %.3e, viscous %.6e, dashpots %.6e, "
      "friction %.6e, residual %.3e = %.2e\n",
      name, b.work, b.change.kinetic, b.change.strain, b.change.contact, b.change.gravity, b.viscous,
      b.contact_dashpots, b.friction, b.residual(), b.relative());
}

double stable_step(const qdem::Model& model, const qdem::State& state, const qdem::Engine& engine) {
  return qdem::StepBound(model).at(state, engine.contacts(), qdem::near_gap(model.contact));
}

}  // namespace

TEST(ViscousPower, OfAUniformStrainRate) {
  // V (lambda_v tr(D)^2 + 2 mu_v D : D), whatever the mesh, the scale and the lane.
  const auto shape = tests::box_template({3, 2, 2}, {0.3, 0.2, 0.2}, 0.01);
  for (const int n : {1, 9}) {
    qdem::Material material = tests::rock();
    material.lame_viscosity = 300, material.shear_viscosity = 500;
    auto model = tests::free_bodies(shape, material, n);
    for (int b = 0; b < n; ++b) model.bodies[b].scale = 1 + 0.1 * b;
    qdem::make_batches(model);
    auto state = qdem::make_state(model, tests::apart(n, 1.0));
    Matrix3d rate;
    rate << 0.1, 0.02, -0.03, 0.05, -0.04, 0.01, 0.02, 0.06, 0.08;
    double volume = 0.0;
    for (int b = 0; b < n; ++b) {
      volume += std::pow(model.bodies[b].scale, 3) * model.shape(b).volume();
      for (int i = 0; i < model.shape(b).n_nodes(); ++i) {
        qdem::State::scatter(model, state.v, b, i, rate * state.position(model, b, i));
      }
    }
    const Matrix3d d = 0.5 * (rate + rate.transpose());
    const double expected = volume * (300 * d.trace() * d.trace() + 2 * 500 * d.squaredNorm());
    qdem::Engine engine(model, {1});
    EXPECT_TRUE(near_rel(engine.viscous_power(state), expected, 1e-12)) << n << " bodies";
  }
}

TEST(ViscousPower, IsWhatTheForcesTakeFromTheMotion) {
  // Springs taken out of the material, the elements' forces are the dashpots': their power on the particles is minus
  // what is dissipated.
  for (const bool bonds : {false, true}) {
    qdem::Material material = tests::rock();
    if (bonds) material = tests::bonded(material);
    material.lame_viscosity = 300, material.shear_viscosity = 500;
    auto model = tests::free_bodies(tests::box_template({2, 2, 2}, Vector3d::Constant(0.1), 0.005), material);
    model.materials[0].young = 0;
    auto state = qdem::make_state(model, {{}});
    std::mt19937_64 random(3);
    for (double& v : state.v) v = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
    double power = 0.0;
    const auto forces = tests::forces(model, state);
    for (int i = 0; i < model.shape(0).n_nodes(); ++i) power += forces[i].dot(state.velocity(model, 0, i));
    EXPECT_TRUE(near_rel(qdem::Engine(model, {1}).viscous_power(state), -power, 1e-11)) << bonds;
  }
}

namespace {

/// A bar of rock that rings in its first longitudinal mode.
qdem::EnergyBalance ringing_bar(double share_of_step, int steps_per_sample) {
  const double length = 0.2;
  const auto model = tests::free_bodies(tests::box_template({10, 2, 2}, {length, 0.04, 0.04}),
                                        tests::with_retardation(tests::rock(), 2e-6));
  auto state = qdem::make_state(model, {{}});
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    const double x = state.position(model, 0, i)[0] / length;
    qdem::State::scatter(model, state.v, 0, i, {0.1 * std::cos(M_PI * x), 0, 0});
  }
  qdem::EngineOptions options{1};
  options.steps_per_viscous_sample = steps_per_sample;
  qdem::Engine engine(model, options);
  engine.prepare(state);
  engine.open_ledger(state);
  const double end = 4e-4, dt = share_of_step * stable_step(model, state, engine);
  const auto n = static_cast<std::int64_t>(std::ceil(end / dt));
  engine.advance(state, end / static_cast<double>(n), n);
  return engine.balance(state);
}

}  // namespace

TEST(Ledger, ViscousDissipationOfABar) {
  // It has little motion left; what it lost is found in the dashpots, step by step or by random samples.
  const auto balance = ringing_bar(0.8, 1), sampled = ringing_bar(0.8, qdem::EngineOptions().steps_per_viscous_sample);
  print("ringing bar", balance), print("sampled", sampled);
  EXPECT_TRUE(near_abs(balance.relative(), 0.0, 2e-3));
  EXPECT_GT(balance.viscous, 0.5 * balance.scale);
  EXPECT_NE(sampled.viscous, balance.viscous);
  EXPECT_TRUE(near_rel(sampled.viscous, balance.viscous, 0.1));
}

TEST(Ledger, ResidualOfABarIsOfSecondOrder) {
  std::vector<double> steps, residuals;
  for (const double share : {0.8, 0.4, 0.2, 0.1}) {
    steps.push_back(share), residuals.push_back(std::abs(ringing_bar(share, 1).relative()));
    std::printf("share %.2f: residual %.3e\n", share, residuals.back());
  }
  EXPECT_TRUE(tests::converges_with_order(steps, residuals, 2.0, 0.2));
}

namespace {

/// A block that falls flat on the ground, sinks in, rebounds and is pressed by pads with a moving foot: elements,
/// contacts, gravity and pads together. Without friction unless `friction` is given.
class PressedBlock {
 public:
  explicit PressedBlock(double friction, double zeta = 0.1)
      : model_(tests::free_bodies(tests::box_template({2, 2, 2}, Vector3d::Constant(0.1)),
                                  tests::with_retardation(tests::rock(), 2e-6))) {
    model_.materials[0].young *= 1e-2;
    model_.gravity = {0.3, 0, -9.81};
    model_.contact = {1e6, 0.8, zeta, friction, rounding};
    model_.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, friction});
    qdem::PadCell cell;
    cell.axes = Matrix3d::Identity();
    for (auto& law : cell.laws) law.stiffness = 2e6, law.damping = 100;
    for (int i = 0; i < model_.shape(0).n_nodes(); ++i) {
      if (model_.shape(0).nodes[i][2] > 0.0999) cell.nodes.push_back(i);
    }
    cell.weights.assign(cell.nodes.size(), 1.0 / static_cast<double>(cell.nodes.size()));
    model_.pads.push_back(cell), model_.pad_body = 0;
    start_ = qdem::make_state(model_, {{Matrix3d::Identity(), {0, 0, rounding - 2e-5}}});
  }

  double step() const {
    qdem::State state = start_;
    qdem::Engine engine(model_, {1});
    engine.prepare(state);
    return stable_step(model_, state, engine);
  }

  /// The foot goes down and along in `n_windows` windows.
  qdem::EnergyBalance press(std::int64_t steps_a_window, int n_windows = 20) const {
    qdem::State state = start_;
    qdem::EngineOptions options{1};
    options.steps_per_viscous_sample = 1;
    qdem::Engine engine(model_, options);
    engine.set_pad_reference(start_.x);
    engine.prepare(state);
    engine.open_ledger(state);
    const double window = 1e-4;
    for (int w = 0; w < n_windows; ++w) {
      engine.advance(state, window / static_cast<double>(steps_a_window), steps_a_window, {foot(w), foot(w + 1)});
    }
    return engine.balance(state);
  }

 private:
  static std::vector<double> foot(int window) {
    const double down = 1 - std::cos(0.3 * window);
    return {1e-5 * down, 0.0, -4e-5 * down};
  }
  qdem::Model model_;
  qdem::State start_;
};

void expect_order(const PressedBlock& block, double order, double tolerance) {
  const auto least = static_cast<std::int64_t>(std::ceil(1e-4 / (0.8 * block.step())));
  std::vector<double> steps, residuals;
  for (const int finer : {1, 2, 4, 8}) {
    const auto balance = block.press(finer * least);
    print("pressed block", balance);
    steps.push_back(1.0 / finer), residuals.push_back(std::abs(balance.relative()));
  }
  std::printf("order %.3f\n", tests::fitted_order(steps, residuals));
  EXPECT_TRUE(tests::converges_with_order(steps, residuals, order, tolerance));
  EXPECT_LT(residuals[0], 0.01);
}

}  // namespace

TEST(Ledger, ResidualOfAPressedBlockIsOfSecondOrder) {
  expect_order(PressedBlock(0.0), 2.0, 0.25);
}

namespace {

/// A block that swings sideways on springs that stick, without a dashpot anywhere; and the step it took.
std::pair<qdem::EnergyBalance, double> sticking_block(double share_of_step) {
  auto model = tests::free_bodies(tests::box_template({2, 2, 2}, Vector3d::Constant(0.1)), tests::rock());
  model.gravity = {0, 0, -9.81};
  model.contact = {1e6, 0.8, 0.0, 0.9, rounding};
  model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.9});
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) model.fixities.push_back({0, i, 6u});  // it does not rock
  auto state = qdem::make_state(model, {{Matrix3d::Identity(), {0, 0, rounding - 1e-5}}});
  set_velocity(model, state, 0, {1e-3, 0, 0});
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  engine.open_ledger(state);
  const double end = 0.02, dt = share_of_step * stable_step(model, state, engine);
  const auto n = static_cast<std::int64_t>(std::ceil(end / dt));
  engine.advance(state, end / static_cast<double>(n), n);
  return {engine.balance(state), end / static_cast<double>(n)};
}

}  // namespace

TEST(Ledger, FindsWhatStickingSpringsLoseInAStep) {
  // The law stretches its spring by v dt with the velocity at the step's end, which acts as a dashpot k_t dt/2 more. It
  // belongs to no flow, so it is the residual; of first order, which the swing's decay confirms: all nine springs
  // on the ground together are c = 9 k_t dt/2, and the swing's energy goes with exp(-c t/m).
  std::vector<double> steps, residuals;
  for (const double share : {0.8, 0.4, 0.2}) {
    const auto [balance, dt] = sticking_block(share);
    print("sticking block", balance);
    EXPECT_EQ(balance.friction, 0.0);
    steps.push_back(share), residuals.push_back(-balance.relative());
    const double mass = 0.001 * 2700, lost = 1 - std::exp(-9 * 0.8e6 * dt / 2 * 0.02 / mass);
    std::printf("lost %.4e, expected %.4e\n", residuals.back(), lost);
    EXPECT_TRUE(near_rel(residuals.back(), lost, 0.02));
  }
  EXPECT_TRUE(tests::converges_with_order(steps, residuals, 1.0, 0.1));
}

TEST(Ledger, DashpotsOfARebound) {
  // A cube that stands on its vertex falls on the ground: half m v^2 (1 - e^2), e of contact_restitution.cpp.
  const double speed = 0.1, zeta = 0.3;
  auto model = tests::free_bodies(tests::box_template({1, 1, 1}, Vector3d::Constant(0.04)), tests::rock());
  model.contact = {1e5, 0.8, zeta, 0.0, rounding};
  model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.0});
  const Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(Vector3d::Ones(), Vector3d::UnitZ()).toRotationMatrix();
  auto state = qdem::make_state(model, {{turn, {0, 0, rounding + 1e-6}}});
  set_velocity(model, state, 0, {0, 0, -speed});
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  engine.open_ledger(state);
  const double dt = 0.2 * qdem::StepBound(model).at(state, engine.contacts(), rounding);
  engine.advance(state, dt, std::llround(3 * M_PI * std::sqrt(model.body_mass(0) / 1e5) / dt));
  const auto balance = engine.balance(state);
  print("rebound", balance);
  const double phi = std::asin(zeta), e = std::exp(-std::tan(phi) * (M_PI - 2 * phi));
  const double lost = 0.5 * model.body_mass(0) * speed * speed * (1 - e * e);
  EXPECT_TRUE(near_rel(balance.contact_dashpots, lost, 0.01));
  EXPECT_EQ(balance.friction, 0.0);
  EXPECT_TRUE(near_abs(balance.relative(), 0.0, 1e-4));
}

TEST(Ledger, FrictionOfASlide) {
  // A block that is thrown along the ground stops by friction: m v^2/2 less what the dashpots took.
  const double speed = 0.3;
  auto model = tests::free_bodies(tests::box_template({2, 2, 1}, {0.1, 0.1, 0.02}),
                                  tests::with_retardation(tests::rock(), 1e-6));
  model.gravity = {0, 0, -9.81};
  model.contact = {1e6, 0.8, 0.1, 0.3, rounding};
  model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.3});
  const double sunk = model.body_mass(0) * 9.81 / (9 * 1e6);
  auto state = qdem::make_state(model, {{Matrix3d::Identity(), {0, 0, rounding - sunk}}});
  set_velocity(model, state, 0, {speed, 0, 0});
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  engine.open_ledger(state);
  const double dt = 0.5 * stable_step(model, state, engine), stop = speed / (0.3 * 9.81);
  engine.advance(state, dt, std::llround(1.1 * stop / dt));
  const auto balance = engine.balance(state);
  print("slide", balance);
  const double thrown = 0.5 * model.body_mass(0) * speed * speed;
  EXPECT_TRUE(near_rel(balance.change.kinetic, -thrown, 1e-4));
  EXPECT_TRUE(near_rel(balance.friction, thrown, 0.01));
  EXPECT_TRUE(near_abs(balance.relative(), 0.0, 0.005));
}

TEST(Ledger, EnergyThatIsSmuggledInIsTheResidual) {
  auto model = tests::free_bodies(tests::box_template({2, 2, 2}, Vector3d::Constant(0.05)),
                                  tests::with_retardation(tests::rock(), 1e-6));
  model.contact = {1e6, 0.8, 0.1, 0.3, rounding};
  model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.3});
  auto state = qdem::make_state(model, {{Matrix3d::Identity(), {0, 0, rounding + 1e-5}}});
  set_velocity(model, state, 0, {0.05, 0, -0.1});
  qdem::Engine engine(model, {1, {}, 1});
  engine.prepare(state);
  engine.open_ledger(state);
  const double dt = 0.2 * qdem::StepBound(model).at(state, engine.contacts(), rounding);
  engine.advance(state, dt, 4000);
  const double before = engine.balance(state).residual(), kinetic = engine.kinetic_energy(state);
  for (double& v : state.v) v *= 1.1;
  engine.advance(state, dt, 1000);
  const double found = engine.balance(state).residual() - before;
  EXPECT_TRUE(near_rel(found, 0.21 * kinetic, 0.01));
  EXPECT_GT(engine.balance(state).relative(), 0.02);
}
