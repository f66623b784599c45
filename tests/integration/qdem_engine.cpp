// The engine as a whole: lanes, threads, snapshots, pads, contact.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>

#include "proto/case/rail_seat.hpp"
#include "proto/error.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/model/pad_cells.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/falling_heap.hpp"
#include "tests/support/tolerance.hpp"

using Eigen::Vector3d;
using tests::near_abs;
using tests::near_rel;

namespace {

constexpr double step = tests::heap_step;

void expect_threads_change_no_bit(const qdem::Model& model) {
  qdem::State one = tests::heap_state(model), two = one, three = one;
  qdem::Engine engine_one(model, {1}), engine_two(model, {2}), engine_three(model, {3});
  const auto run = [](qdem::Engine& engine, qdem::State& state) {
    engine.prepare(state);
    engine.open_ledger(state);
    engine.advance(state, step, 3000);
  };
  run(engine_one, one), run(engine_two, two), run(engine_three, three);
  EXPECT_GT(engine_one.contacts().report(one).live, 4);
  EXPECT_GT(one.ledger.friction, 0);
  tests::expect_same_bytes(one, two);
  tests::expect_same_bytes(one, three);
}

}  // namespace

TEST(Engine, ThreadsDoNotChangeABit) {
  expect_threads_change_no_bit(tests::heap());
}

TEST(Engine, ThreadsDoNotChangeABitOfBonds) {
  expect_threads_change_no_bit(tests::heap(qdem::Interaction::bond));
}

TEST(Engine, ThreadsDoNotChangeABitOfSpheres) {
  expect_threads_change_no_bit(tests::heap_of_spheres());
}

namespace {

void expect_a_restored_snapshot_continues(const qdem::Model& model) {
  qdem::State state = tests::heap_state(model);
  qdem::Engine engine(model, {2});
  engine.prepare(state);
  engine.open_ledger(state);
  engine.advance(state, step, 1800);
  const qdem::State snapshot = state;
  engine.advance(state, step, 1000);
  qdem::State again = snapshot;
  engine.advance(again, step, 1000);  // by the engine that has been further already
  tests::expect_same_bytes(state, again);
  qdem::State fresh = snapshot;
  qdem::Engine other(model, {1});  // by an engine that never saw the first half
  other.advance(fresh, step, 1000);
  tests::expect_same_bytes(state, fresh);
  EXPECT_GT(engine.contacts().report(state).live, 4);
}

}  // namespace

TEST(Engine, RestoredSnapshotContinuesWithTheSameBytes) {
  expect_a_restored_snapshot_continues(tests::heap());
}

TEST(Engine, RestoredSnapshotOfSpheresContinuesWithTheSameBytes) {
  expect_a_restored_snapshot_continues(tests::heap_of_spheres());
}

namespace {

/// The same distorted body once among siblings in lanes of three scales, once alone.
void expect_lanes_and_single_bodies_agree(const qdem::Material& material) {
  const auto shape = tests::box_template({3, 2, 2}, {0.06, 0.04, 0.04}, 2e-3);
  auto many = tests::free_bodies(shape, material, 11);
  for (int i = 0; i < 11; ++i) many.bodies[i].scale = 0.8 + 0.05 * i;
  many.gravity = {1, 2, -9.81};
  qdem::make_batches(many);
  ASSERT_EQ(many.stride(4), qdem::lane_width);
  qdem::State state = qdem::make_state(many, tests::apart(11, 0.5));
  qdem::Engine engine(many, {1});
  for (int body = 0; body < 11; ++body) {
    auto alone = tests::free_bodies(shape, material);
    alone.bodies[0].scale = many.bodies[body].scale, alone.gravity = many.gravity;
    qdem::make_batches(alone);
    ASSERT_EQ(alone.stride(0), 1);
    qdem::State single = qdem::make_state(alone, {tests::apart(11, 0.5)[body]});
    qdem::State all = state;
    for (int node = 0; node < shape.n_nodes(); ++node) {
      const Vector3d v(0.3 * std::sin(node + body), 0.2 * std::cos(3.0 * node), 0.1 * node / shape.n_nodes());
      qdem::State::scatter(alone, single.v, 0, node, v);
      qdem::State::scatter(many, all.v, body, node, v);
    }
    qdem::Engine one(alone, {1});
    one.prepare(single), one.advance(single, 2e-7, 50);
    engine.prepare(all), engine.advance(all, 2e-7, 50);
    for (int node = 0; node < shape.n_nodes(); ++node) {
      EXPECT_LT((single.velocity(alone, 0, node) - all.velocity(many, body, node)).norm(), 1e-9) << body;
      EXPECT_LT((single.position(alone, 0, node) - all.position(many, body, node)).norm(), 1e-15 * 10) << body;
    }
  }
}

}  // namespace

TEST(Engine, LanesAndSingleBodiesAgree) {
  expect_lanes_and_single_bodies_agree(tests::with_retardation(tests::rock(), 1e-7));
}

TEST(Engine, LanesAndSingleBodiesAgreeOnBonds) {
  expect_lanes_and_single_bodies_agree(tests::bonded(tests::with_retardation(tests::rock(), 1e-7)));
}

TEST(Engine, NamesTheBodyThatBlowsUp) {
  auto model = tests::free_bodies(tests::box_template({1, 1, 1}, {0.05, 0.05, 0.05}), tests::rock(), 4);
  model.bodies[2].name = "the culprit";
  qdem::State state = qdem::make_state(model, tests::apart(4, 0.5));
  qdem::State::scatter(model, state.v, 2, 3, {std::nan(""), 0, 0});
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  try {
    engine.advance(state, 1e-7, 10);
    FAIL() << "NaN was not noticed";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    EXPECT_NE(std::string(error.what()).find("the culprit"), std::string::npos) << error.what();
  }
}

namespace {

/// A free block under a pad of two cells, no contact, no gravity.
struct BlockUnderPad {
  qdem::Model model;
  qdem::State state;
  qdem::State rest;
  explicit BlockUnderPad(bool cutoff) {
    model = tests::free_bodies(tests::box_template({4, 4, 2}, {0.2, 0.2, 0.1}),
                               tests::with_retardation(tests::rock(), 1e-7));
    model.pad_body = 0;
    proto::RailSeat seat;
    seat.name = "seat", seat.axes = Eigen::AngleAxisd(0.4, Vector3d::UnitZ()).toRotationMatrix();
    seat.origin = {0.1, 0.1, 0.1};
    seat.half_lengths = {0.05, 0.04}, seat.cells = {2, 1};
    seat.stiffness = {6e6, 5e6, 2e7}, seat.damping = {1e3, 2e3, 3e3};
    seat.clip_preload = 50.0, seat.tension_cutoff = cutoff;
    state = rest = qdem::make_state(model, {{}});
    model.pads = qdem::make_pad_cells(model, state, 0, {seat});
  }
  Vector3d momentum(const qdem::State& s) const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < model.shape(0).n_nodes(); ++i) sum += model.node_mass(0, i) * s.velocity(model, 0, i);
    return sum;
  }
};

}  // namespace

TEST(Pads, ImpulseIsTheMomentumGainedAndWorkBalancesEnergy) {
  for (const bool cutoff : {false, true}) {
    BlockUnderPad block(cutoff);
    qdem::Engine engine(block.model, {1});
    engine.set_pad_reference(block.rest.x);
    engine.prepare(block.state);
    const int n_windows = 200, sub_cycles = 50;
    const double window = 1e-5;
    std::vector<double> u(6, 0.0), impulse(6, 0.0);
    double work = 0, dissipated = 0;
    for (int n = 0; n < n_windows; ++n) {
      std::vector<double> next(6);
      for (int i = 0; i < 6; ++i) next[i] = 1e-5 * std::sin(2e3 * (n + 1) * window + i) - 1e-5 * std::sin(i);
      const auto v0 = engine.pad_velocity(block.state);
      const auto sums = engine.advance(block.state, window / sub_cycles, sub_cycles, {u, next});
      const auto v1 = engine.pad_velocity(block.state);
      for (int i = 0; i < 6; ++i) {
        impulse[i] += sums.impulse[i], work += sums.work[i];
        // Window-mean relative velocity is enough for the energy lost in the dashpots.
        const double rate = (next[i] - u[i]) / window - 0.5 * (v0[i] + v1[i]);
        dissipated += window * block.model.pads[i / 3].laws[i % 3].damping * rate * rate;
      }
      u = next;
    }
    Vector3d total = Vector3d::Zero();
    for (int cell = 0; cell < 2; ++cell) {
      total += block.model.pads[cell].axes * Vector3d(impulse[3 * cell], impulse[3 * cell + 1], impulse[3 * cell + 2]);
    }
    const Vector3d gained = block.momentum(block.state);
    ASSERT_GT(gained.norm(), 1e-3);
    EXPECT_LT((total - gained).norm(), 1e-3 * gained.norm()) << "cut-off " << cutoff;
    if (cutoff) continue;
    const auto energies = engine.energies(block.state);
    const auto x = engine.pad_displacement(block.state, block.rest.x);
    double springs = 0;
    for (int i = 0; i < 6; ++i)
      springs += 0.5 * block.model.pads[i / 3].laws[i % 3].stiffness * (u[i] - x[i]) * (u[i] - x[i]);
    EXPECT_TRUE(near_rel(energies.kinetic + energies.strain + springs + dissipated, work, 0.01));
  }
}

TEST(Pads, ASteadyRailIsExactlyTheLaw) {
  // A sleeper held everywhere: its pad force is the law of the rail's motion alone, cut-off included.
  BlockUnderPad block(true);
  for (int i = 0; i < block.model.shape(0).n_nodes(); ++i) block.model.fixities.push_back({0, i, 7u});
  qdem::Engine engine(block.model, {1});
  engine.set_pad_reference(block.rest.x);
  engine.prepare(block.state);
  const std::vector<double> begin{1e-6, 2e-6, -3e-6, 0, 1e-6, 4e-5}, end{2e-6, 2e-6, -5e-6, 1e-6, 0, 5e-5};
  const double window = 1e-4;
  const auto sums = engine.advance(block.state, window / 20, 20, {begin, end});
  for (int i = 0; i < 6; ++i) {
    const auto& law = block.model.pads[i / 3].laws[i % 3];
    const double rate = (end[i] - begin[i]) / window;
    const double mean = 0.5 * (law.force(begin[i], rate) + law.force(end[i], rate));  // linear, or cut off throughout
    EXPECT_TRUE(near_rel(sums.impulse[i], mean * window, 1e-12)) << i;
    EXPECT_TRUE(near_abs(sums.work[i], mean * (end[i] - begin[i]), 1e-12 * std::abs(mean) * 1e-5)) << i;
    EXPECT_TRUE(near_rel(block.state.pad_force[i], law.force(end[i], rate), 1e-12)) << i;
  }
  EXPECT_EQ(block.state.pad_force[5], block.model.pads[1].laws[2].preload);
}

TEST(Engine, UnbalancedRatioIsNewtonsLawOverTheContactForce) {
  // On a plane without friction every contact force is vertical, so their sizes sum up to M (g + a) for a cube with the
  // mean acceleration a.
  auto soft = tests::rock();
  soft.young = 1e8;
  auto model = tests::free_bodies(tests::box_template({2, 2, 2}, {0.04, 0.04, 0.04}), soft, 1);
  model.gravity = {0, 0, -9.81};
  model.contact = {1e5, 0.0, 0.2, 0.0, 1e-3};
  model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.0});
  qdem::make_batches(model);
  qdem::Placement place;
  place.translation = Vector3d(0, 0, 1.001e-3);
  qdem::State state = qdem::make_state(model, {place});
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  EXPECT_EQ(engine.unbalanced_ratio(state), 1.0) << "it falls";
  int n_touching = 0;
  for (int look = 0; look < 200; ++look) {
    engine.advance(state, step, 20);
    double mass = 0.0, force = 0.0;
    for (int node = 0; node < model.shape(0).n_nodes(); ++node) {
      mass += model.node_mass(0, node);
      force += model.node_mass(0, node) * qdem::State::gather(model, state.a, 0, node)[2];
    }
    const double contact = force + mass * 9.81;
    if (contact < 0.01 * mass * 9.81) continue;  // in the air
    ++n_touching;
    ASSERT_TRUE(near_abs(engine.unbalanced_ratio(state), std::abs(force) / contact, 1e-12)) << look;
  }
  EXPECT_GT(n_touching, 100);
}
