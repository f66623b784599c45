// Absorbing boundaries: what comes back of plane waves, what holds a static load, where the energy goes, and what step
// is stable.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <cstring>

#include "proto/error.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/ground_column.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;
using tests::GroundColumn;
using tests::near_abs;
using tests::near_rel;

constexpr double brick = 0.05;
constexpr int n_bricks = 80;
constexpr double depth = n_bricks * brick;

/// What is left in the column, over the pulse, when the pulse has gone to the bottom and back up half way.
double reflected(int axis, GroundColumn::Bottom bottom, double pulse_length, double alpha = 0.0) {
  GroundColumn column(n_bricks, brick, axis, bottom, alpha);
  column.start_pulse(-depth / 2, pulse_length, 1e-5);
  qdem::Engine engine(column.model(), {1});
  engine.prepare(column.state());
  const double time = depth / column.wave_speed(), dt = 0.5 * column.stable_step();
  const auto n = static_cast<std::int64_t>(std::ceil(time / dt));
  engine.advance(column.state(), time / static_cast<double>(n), n);
  return column.largest_displacement() / 1e-5;
}

class PlaneWave : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(PAndS, PlaneWave, testing::Values(2, 0),
                         [](const auto& wave) { return std::string(wave.param == 2 ? "P" : "S"); });

}  // namespace

TEST_P(PlaneWave, LeavesThroughTheBottom) {
  // Lysmer and Kuhlemeyer 1969: nothing of a plane wave at normal incidence comes back. What does is the mesh's.
  double before = 0.02;
  for (const int bricks : {12, 18, 30}) {
    const double found = reflected(GetParam(), GroundColumn::Bottom::absorbing, bricks * brick);
    const double fixed = reflected(GetParam(), GroundColumn::Bottom::fixed, bricks * brick);
    std::printf("pulse of %d bricks: reflected %.4f; of a fixed bottom %.4f\n", bricks, found, fixed);
    EXPECT_LT(found, before);
    EXPECT_TRUE(near_abs(fixed, 1.0, 0.05));  // peaks fall between particles
    before = 0.7 * found;
  }
}

TEST_P(PlaneWave, SpringsSendLongOnesBack) {
  // Springs are made for waves that spread. Of a plane wave f they return g with g' + b g = -b f, b = k/(2 rho c A),
  // from the balance of tractions at the bottom.
  const double length = 30 * brick;
  GroundColumn column(n_bricks, brick, GetParam(), GroundColumn::Bottom::absorbing, 1.0);
  const auto& soil = column.model().materials[0];
  double spring = 0.0;  // k/A
  for (const auto& particle : column.model().boundary) spring += particle.stiffness[GetParam()] / (brick * brick);
  const double rate = spring / (2 * soil.density * column.wave_speed()), duration = length / column.wave_speed();
  double g = 0.0, expected = 0.0;
  const int n = 10000;
  for (int i = 0; i < n; ++i) {
    g -= duration / n * rate * (g + std::pow(std::sin(M_PI * (i + 0.5) / n), 2));
    expected = std::max(expected, -g);
  }
  const double found = reflected(GetParam(), GroundColumn::Bottom::absorbing, length, 1.0);
  std::printf("reflected with springs: %.4f for %.4f\n", found, expected);
  EXPECT_TRUE(near_rel(found, expected, 0.03));
}

TEST_P(PlaneWave, AStaticLoadIsHeldBySpringsAtTheDepth) {
  // Uniform pressure p: p H/M in the column, p R/(alpha G) below it, R = H.
  GroundColumn column(20, brick, GetParam(), GroundColumn::Bottom::absorbing, 1.0);
  const auto& soil = column.model().materials[0];
  const double p = 1e3, height = 20 * brick;
  qdem::PatchLoad load;
  Vector3d direction = Vector3d::Zero();
  direction[GetParam()] = -1;
  load.patch = qdem::make_patch(column.model(), column.state(), 0,
                                {{brick / 2, brick / 2, 0}, 0.0, {brick, brick, 1e-6}}, direction);
  load.history = [&](double) { return p * brick * brick; };
  column.model().loads = {load};
  qdem::Engine engine(column.model(), {1});
  engine.prepare(column.state());
  const double dt = 0.8 * column.stable_step();
  engine.advance(column.state(), dt, static_cast<std::int64_t>(60 * height / column.wave_speed() / dt));
  const double modulus = GetParam() == 2 ? soil.lambda() + 2 * soil.mu() : soil.mu();
  // The bottom's four particles are not equally far from the source on the column's axis: 1/R is a mean of theirs.
  double inverse_distance = 0.0;
  for (const auto& particle : column.model().boundary) {
    inverse_distance += particle.stiffness[GetParam()] / (soil.mu() * brick * brick);
  }
  EXPECT_TRUE(near_rel(inverse_distance, 1 / height, 1e-3));
  const double expected = p * (height / modulus + 1 / (soil.mu() * inverse_distance));
  std::printf("settled %.6e for %.6e m\n", column.state().loads[0].path, expected);
  EXPECT_TRUE(near_rel(column.state().loads[0].path, expected, 1e-3));
}

namespace {

/// A quarter of a half-space's part: a cube of `cells` bricks under a uniformly loaded square of 4 x 4 bricks,
/// symmetric about two planes; its other sides absorb, or are fixed. The square's mean settlement over that of the
/// half-space.
double settlement_ratio(int cells, GroundColumn::Bottom sides) {
  const double h = 0.1, size = cells * h, half = 2 * h, load = 1e3;
  tests::Mesh mesh = tests::box_mesh({cells, cells, cells}, Vector3d::Constant(size));
  for (auto& node : mesh.nodes) node[2] -= size;
  // What rings in single bricks dies out by viscosity.
  qdem::Model model = tests::free_bodies(qdem::make_template("ground", mesh.nodes, mesh.tets),
                                         tests::with_retardation(tests::soil(), 2e-4));
  qdem::State state = qdem::make_state(model, {{}});
  const bool is_fixed = sides == GroundColumn::Bottom::fixed;
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    const Vector3d& x = model.shape(0).nodes[i];
    const bool is_end = x[0] > size - 1e-9 || x[1] > size - 1e-9 || x[2] < 1e-9 - size;
    const unsigned symmetric = (x[0] < 1e-9 ? 1u : 0u) | (x[1] < 1e-9 ? 2u : 0u);
    const unsigned mask = is_fixed && is_end ? 7u : symmetric;
    if (mask != 0) model.fixities.push_back({0, i, mask});
  }
  if (is_fixed) {
    model.drag_per_s = 60;  // no dashpots bring it to rest
  } else {
    qdem::FarField far;
    far.spreading = qdem::Spreading::from_point;
    far.normal_stiffness = 4.0 / 3, far.tangential_stiffness = 2.0 / 3;
    model.boundary = qdem::absorbing_boundary(model, state, 0, {{0, 1}, {1, 1}, {2, -1}}, far);
  }
  qdem::PatchLoad patch;
  patch.patch = qdem::make_patch(model, state, 0, {{half / 2, half / 2, 0}, 0.0, Vector3d::Constant(half / 2 + 1e-6)},
                                 {0, 0, -1});
  patch.history = [=](double) { return load * half * half; };
  model.loads = {patch};
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  const qdem::Material& soil = model.materials[0];
  const double dt = 0.8 * qdem::StepBound(model).at(state, engine.contacts(), 0.0);
  engine.advance(state, dt, static_cast<std::int64_t>(15 * size / std::sqrt(soil.mu() / soil.density) / dt));
  // Boussinesq's point load integrated twice over a square of side B: q B (1 - nu^2)/(pi E) times the mean of 1/r.
  const double mean_of_inverse = 4 * std::log(1 + std::sqrt(2.0)) + 4.0 / 3 * (1 - std::sqrt(2.0));
  const double exact = load * 2 * half * (1 - soil.poisson * soil.poisson) / soil.young * mean_of_inverse / M_PI;
  return state.loads[0].path / exact;
}

}  // namespace

TEST(HalfSpace, SettlesUnderASquareAsBoussinesqSays) {
  // An error of the boundary goes with one over its distance, here 1.5 and 3 sides of the square; what is left without
  // it is that of four bricks across the square.
  using Bottom = GroundColumn::Bottom;
  const double near = settlement_ratio(6, Bottom::absorbing), far = settlement_ratio(12, Bottom::absorbing);
  const double near_fixed = settlement_ratio(6, Bottom::fixed), far_fixed = settlement_ratio(12, Bottom::fixed);
  const double unbounded = 2 * far - near, unbounded_fixed = 2 * far_fixed - near_fixed;
  std::printf("over Boussinesq's: springs %.4f, %.4f, unbounded %.4f; fixed %.4f, %.4f, unbounded %.4f\n", near, far,
              unbounded, near_fixed, far_fixed, unbounded_fixed);
  EXPECT_TRUE(near_rel(unbounded, unbounded_fixed, 0.03));
  EXPECT_TRUE(near_rel(unbounded, 1.0, 0.06));
  EXPECT_TRUE(near_rel(far, unbounded, 0.06));
  EXPECT_GT(std::abs(far_fixed - unbounded), 2 * std::abs(far - unbounded));
}

TEST(Ledger, HasWhatIsRadiatedAsASinkOfItsOwn) {
  // All of the pulse's energy goes through the bottom.
  std::vector<double> steps, residuals;
  for (const double share : {0.8, 0.4, 0.2}) {
    GroundColumn column(n_bricks, brick, 2, GroundColumn::Bottom::absorbing, 1.0);
    column.start_pulse(-depth / 2, 30 * brick, 1e-5);
    qdem::Engine engine(column.model(), {1});
    engine.prepare(column.state());
    engine.open_ledger(column.state());
    const double time = depth / column.wave_speed();
    const auto n = static_cast<std::int64_t>(std::ceil(time / (share * column.stable_step())));
    engine.advance(column.state(), time / static_cast<double>(n), n);
    const auto balance = engine.balance(column.state());
    const double pulse =
        balance.stored.kinetic + balance.stored.strain - balance.change.kinetic - balance.change.strain;
    std::printf("radiated %.5f of the pulse, left %.2e, residual %.2e\n", balance.radiated / pulse,
                (balance.stored.kinetic + balance.stored.strain + balance.stored.boundary) / pulse, balance.relative());
    EXPECT_TRUE(near_rel(balance.radiated, pulse, 0.02));
    EXPECT_EQ(balance.dissipated(), balance.radiated);
    steps.push_back(share), residuals.push_back(std::abs(balance.relative()));
  }
  EXPECT_TRUE(tests::converges_with_order(steps, residuals, 2.0, 0.3));
  EXPECT_LT(residuals[0], 1e-3);
}

TEST(StepBound, CountsTheBoundary) {
  const auto speed_after = [](double share, GroundColumn& column) {
    qdem::State state = column.state();
    qdem::Engine engine(column.model(), {1});
    try {
      engine.prepare(state);
      engine.advance(state, share * column.stable_step(), 3000);
    } catch (const proto::Error&) {
      return 1e99;
    }
    return engine.largest_speed(state);
  };
  for (const int axis : {2, 0}) {
    GroundColumn column(20, brick, axis, GroundColumn::Bottom::absorbing, 1.0);
    GroundColumn fixed(20, brick, axis, GroundColumn::Bottom::fixed);
    column.start_pulse(-0.5, 0.3, 1e-5);
    double stable = 1.0, unstable = 4.0;
    EXPECT_LT(speed_after(stable, column), 0.1);
    EXPECT_GT(speed_after(unstable, column), 1.0);
    while (unstable - stable > 0.02) {
      const double share = (stable + unstable) / 2;
      (speed_after(share, column) < 1.0 ? stable : unstable) = share;
    }
    std::printf("axis %d: the bound is %.2f of the step that blows up; it is %.2f of a fixed bottom's\n", axis,
                1 / unstable, column.stable_step() / fixed.stable_step());
    EXPECT_LT(column.stable_step(), fixed.stable_step());
  }
}

TEST(Boundary, EveryNumberOfThreadsAndASnapshotGiveTheSameBits) {
  const auto run = [](int threads, bool by_snapshot) {
    GroundColumn column(n_bricks, brick, 2, GroundColumn::Bottom::absorbing, 1.0);
    column.start_pulse(-0.8 * depth, 10 * brick, 1e-5);
    qdem::EngineOptions options{threads};
    qdem::Engine engine(column.model(), options);
    engine.prepare(column.state());
    engine.open_ledger(column.state());
    const double dt = 0.8 * column.stable_step();
    engine.advance(column.state(), dt, 300);
    if (by_snapshot) {
      const qdem::State snapshot = column.state();
      engine.advance(column.state(), dt, 77);
      column.state() = snapshot;
    }
    engine.advance(column.state(), dt, 300);
    return column.state();
  };
  const qdem::State one = run(1, false);
  for (const qdem::State& other : {run(3, false), run(1, true)}) {
    EXPECT_EQ(std::memcmp(one.x.data(), other.x.data(), 8 * one.x.size()), 0);
    EXPECT_EQ(std::memcmp(one.v.data(), other.v.data(), 8 * one.v.size()), 0);
    EXPECT_EQ(one.ledger.radiated, other.ledger.radiated);
    EXPECT_EQ(one.ledger.radiated_power, other.ledger.radiated_power);
  }
  EXPECT_GT(one.ledger.radiated, 0.0);
}
