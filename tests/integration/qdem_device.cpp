// The device engine against the CPU engine and against itself, on every backend that can run here.
#include <gtest/gtest.h>

#include <cstdlib>

#include "proto/case/rail_seat.hpp"
#include "proto/error.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "qdem_solver/engine/stepper.hpp"
#include "qdem_solver/model/pad_cells.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/falling_heap.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/contact_scene.hpp"

using Eigen::Vector3d;
using qdem::Engine;
using qdem::EngineKind;
using qdem::EngineOptions;
using qdem::State;

namespace {

EngineOptions options(EngineKind kind, std::uint64_t seed = 1) {
  EngineOptions result;
  result.threads = 1, result.kind = kind, result.check_seed = seed;
  return result;
}

/// Runs on every backend; says so and is skipped where the CUDA engine cannot run.
class Device : public testing::TestWithParam<EngineKind> {
 protected:
  void SetUp() override {
    const std::string reason = GetParam() == EngineKind::cuda ? qdem::why_no_cuda() : "";
    if (!reason.empty()) GTEST_SKIP() << "NOT RUN: " << reason;
  }
  static EngineOptions device() { return options(GetParam()); }
};

std::string name_of(const testing::TestParamInfo<EngineKind>& of) {
  return qdem::engine_name(of.param);
}
INSTANTIATE_TEST_SUITE_P(Backends, Device, testing::Values(EngineKind::check, EngineKind::cuda), name_of);

/// In calls of some steps, as a coupled run makes them.
void advance(Engine& engine, State& state, std::int64_t n_steps) {
  for (std::int64_t done = 0; done < n_steps; done += 20) engine.advance(state, tests::heap_step, 20);
}

State stepped(const qdem::Model& model, State state, const EngineOptions& with, std::int64_t n_steps) {
  Engine engine(model, with);
  engine.prepare(state);
  advance(engine, state, n_steps);
  return state;
}

/// Largest difference of a value of two fields over all particles of bodies.
double difference(const qdem::Model& model, const std::vector<double>& p, const std::vector<double>& q) {
  double largest = 0.0;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    for (int node = 0; node < model.shape(body).n_nodes(); ++node) {
      const Vector3d d = State::gather(model, p, body, node) - State::gather(model, q, body, node);
      largest = std::max(largest, d.cwiseAbs().maxCoeff());
      if (!d.allFinite()) return INFINITY;
    }
  }
  return largest;
}

double largest(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

/// Two engines take sums in different orders. A force is then off by what a round-off of the positions (1e-16 m at half
/// a metre) makes in the stiffest springs, and that is a movement of the same size in a step; a hundred such are
/// allowed for what piles up over some hundred steps, in positions, and in velocities and accelerations what moves as
/// far in a step.
void expect_round_off(const qdem::Model& model, const State& p, const State& q, double step = tests::heap_step) {
  constexpr double round_off = 1e-14;  // [m]
  EXPECT_LT(difference(model, p.x, q.x), round_off);
  EXPECT_LT(difference(model, p.v, q.v), round_off / step);
  EXPECT_LT(difference(model, p.a, q.a), round_off / (step * step));
  ASSERT_TRUE(p.contact.keys == q.contact.keys);
  EXPECT_EQ(p.contact.triangle_offsets, q.contact.triangle_offsets);
  EXPECT_EQ(p.contact.triangles, q.contact.triangles);
  EXPECT_EQ(p.contact.rebuilds, q.contact.rebuilds);
  EXPECT_EQ(p.contact.list_id, q.contact.list_id);
  for (std::size_t i = 0; i < q.contact.slip.size(); ++i) {
    EXPECT_LT((p.contact.slip[i] - q.contact.slip[i]).norm(), round_off) << i;
  }
  EXPECT_EQ(p.step, q.step);
  EXPECT_EQ(p.time, q.time);
}

}  // namespace

TEST_P(Device, AgreesWithTheCpuEngine) {
  for (const auto interaction : {qdem::Interaction::quadruple, qdem::Interaction::bond}) {
    auto model = tests::heap(interaction);
    model.planes[0].velocity = {0.01, 0, 0.02};
    const State start = tests::heap_state(model);
    Engine cpu(model, {1}), device(model, Device::device());
    State p = start, q = start;
    cpu.prepare(p), device.prepare(q);
    expect_round_off(model, q, p);
    advance(cpu, p, 400), advance(device, q, 400);
    const auto report = cpu.contacts().report(p), of_device = device.contacts().report(q);
    EXPECT_GT(report.live, 4);
    EXPECT_GT(p.contact.rebuilds, 2);
    EXPECT_EQ(of_device.live, report.live);
    EXPECT_TRUE(tests::near_rel(of_device.elastic_energy, report.elastic_energy, 1e-9));
    EXPECT_TRUE(tests::near_rel(device.unbalanced_ratio(q), cpu.unbalanced_ratio(p), 1e-9));
    EXPECT_TRUE(tests::near_rel(qdem::StepBound(model).at(q, device.contacts(), 1e-4),
                                qdem::StepBound(model).at(p, cpu.contacts(), 1e-4), 1e-9));
    expect_round_off(model, q, p);
  }
}

TEST_P(Device, FindsTheCandidatesOfTheCpuEngine) {
  std::mt19937_64 random(5);
  for (int scene = 0; scene < 4; ++scene) {
    auto model = tests::model_of_boxes(12 + scene);
    model.bodies[3].kind = qdem::BodyKind::sleeper;
    model.planes.push_back({"ground", {0, 0, -0.05}, {0, 0, 1}, {0, 0, 0}, 0.5});
    model.planes.push_back({"wall", {0.08, 0, 0}, {-0.8, 0.6, 0}, {0, 0, 0}, 0.5, true, false});
    State p = tests::strewn(model, random, 0.08, 1.0), q = p;
    Engine cpu(model, {1}), device(model, Device::device());
    cpu.prepare(p), device.prepare(q);
    ASSERT_GT(p.contact.triangles.size(), 50u);
    EXPECT_TRUE(q.contact.keys == p.contact.keys) << scene;
    EXPECT_EQ(q.contact.triangle_offsets, p.contact.triangle_offsets) << scene;
    EXPECT_EQ(q.contact.triangles, p.contact.triangles) << scene;
    EXPECT_LT(difference(model, q.a, p.a), 1e-11 * largest(p.a)) << scene;
  }
}

TEST_P(Device, RunsAgainWithTheSameBytes) {
  const auto model = tests::heap();
  const State start = tests::heap_state(model);
  tests::expect_same_bytes(stepped(model, start, device(), 200), stepped(model, start, device(), 200));
}

TEST_P(Device, RestoredSnapshotContinuesWithTheSameBytes) {
  const auto model = tests::heap();
  State state = tests::heap_state(model);
  Engine engine(model, device());
  engine.prepare(state);
  advance(engine, state, 300);
  const State snapshot = state;  // shares the device's memory with the state until it is stepped on
  ASSERT_TRUE(snapshot.resident != nullptr);
  advance(engine, state, 100);
  EXPECT_NE(state.resident, snapshot.resident);
  for (int trial = 0; trial < 2; ++trial) {
    State again = snapshot;
    advance(engine, again, 100);
    tests::expect_same_bytes(state, again);
  }
  State from_host = snapshot;
  from_host.resident.reset();
  Engine other(model, device());  // by an engine that never saw the first half
  advance(other, from_host, 100);
  tests::expect_same_bytes(state, from_host);
  EXPECT_GT(engine.contacts().report(state).live, 4);
}

TEST_P(Device, ContinuesWhatTheCpuEngineBeganAndBack) {
  const auto model = tests::heap();
  State p = tests::heap_state(model), q = p;
  Engine cpu(model, {1}), device(model, Device::device());
  cpu.prepare(p), advance(cpu, p, 300);
  cpu.prepare(q), advance(cpu, q, 100), advance(device, q, 100), advance(cpu, q, 100);
  EXPECT_TRUE(q.resident == nullptr) << "the CPU engine moved the state on";
  expect_round_off(model, q, p);
}

TEST_P(Device, HoldsItsOwnModel) {
  auto model = std::make_unique<qdem::Model>(tests::heap());
  const State start = tests::heap_state(*model);
  const State wanted = stepped(*model, start, device(), 100);
  State state = start;
  Engine engine(*model, device());
  engine.prepare(state);
  for (qdem::Template& shape : model->templates) {  // whoever still reads the host's model now gets nonsense
    for (auto* values : {&shape.volumes, &shape.node_volumes}) std::fill(values->begin(), values->end(), NAN);
    for (auto& gradient : shape.gradients) gradient.fill(NAN);
    for (auto& tet : shape.tets) tet.fill(-1);
    for (auto& triangle : shape.triangles) triangle.nodes.fill(-1);
    for (auto& edge : shape.edges) edge.nodes.fill(-1), edge.triangles.fill(-1);
    for (auto* values : {&shape.surface_nodes, &shape.adjacency_offsets, &shape.adjacency_slots}) {
      std::fill(values->begin(), values->end(), -1);
    }
  }
  for (qdem::Material& material : model->materials) material.young = material.density = NAN;
  advance(engine, state, 100);
  tests::expect_same_bytes(state, wanted);
  EXPECT_GT(state.contact.rebuilds, 2);
}

TEST_P(Device, NamesTheBodyWhoseMotionBlowsUp) {
  const auto model = tests::heap();
  State state = tests::heap_state(model);
  Engine engine(model, device());
  engine.prepare(state);
  State::scatter(model, state.v, 7, 3, {0, INFINITY, 0});
  engine.prepare(state);
  try {
    engine.advance(state, tests::heap_step, 5);
    FAIL() << "went on";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    EXPECT_NE(std::string(error.what()).find("body 7 'body 7'"), std::string::npos) << error.what();
  }
}

namespace {

/// A held block under two pad cells, its end nodes held, under its own weight and a load.
struct BlockUnderPads {
  qdem::Model model;
  State state;
  BlockUnderPads() {
    auto material = tests::with_retardation(tests::concrete(), 1e-5);
    model = tests::free_bodies(tests::box_template({4, 4, 2}, {0.2, 0.2, 0.1}, 1e-3), material);
    model.gravity = {0, 0, -9.81};
    model.pad_body = 0;
    model.pad_body_load = {0, 10, -200};
    model.fixities = {{0, 0, 7u}, {0, 10, 4u}, {0, 30, 6u}};
    state = qdem::make_state(model, {{}});
    proto::RailSeat seat;
    seat.name = "seat", seat.axes = Eigen::AngleAxisd(0.4, Vector3d::UnitZ()).toRotationMatrix();
    seat.origin = {0.1, 0.1, 0.1};
    seat.half_lengths = {0.05, 0.04}, seat.cells = {2, 1};
    seat.stiffness = {6e6, 5e6, 2e7}, seat.damping = {1e3, 2e3, 3e3};
    seat.clip_preload = 50.0, seat.tension_cutoff = true;
    model.pads = qdem::make_pad_cells(model, state, 0, {seat});
  }
};

}  // namespace

TEST_P(Device, PadsGiveTheImpulseAndWorkOfTheCpuEngine) {
  const BlockUnderPads block;
  State p = block.state, q = block.state;
  Engine cpu(block.model, {1}), device(block.model, Device::device());
  const auto run = [&](Engine& engine, State& state) {
    engine.set_pad_reference(block.state.x);
    engine.prepare(state);
    std::vector<double> sums, u(6, 0.0), next(6);
    for (int window = 0; window < 20; ++window) {
      for (int i = 0; i < 6; ++i) next[i] = 1e-5 * std::sin(0.3 * (window + 1) + i) - 1e-5 * std::sin(i);
      const auto of_window = engine.advance(state, 2e-7, 20, {u, next});
      sums.insert(sums.end(), of_window.impulse.begin(), of_window.impulse.end());
      sums.insert(sums.end(), of_window.work.begin(), of_window.work.end());
      u = next;
    }
    engine.advance(state, 2e-7, 20);  // the rail is lifted
    return sums;
  };
  const auto wanted = run(cpu, p), reached = run(device, q);
  ASSERT_EQ(reached.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_TRUE(tests::near_abs(reached[i], wanted[i], 1e-11 * largest(wanted))) << i;
  }
  EXPECT_EQ(q.pad_force, std::vector<double>(6, 0.0));
  expect_round_off(block.model, q, p, 2e-7);
}

TEST_P(Device, RelaxesAsTheCpuEngineDoes) {
  auto model = tests::heap();
  model.local_damping = 0.4, model.drag_per_s = 3.0;
  model.fixities = {{20, 0, 2u}, {20, 7, 2u}, {4, 3, 1u}};
  State p = tests::heap_state(model);
  std::mt19937_64 random(3);  // Cundall's damping depends on signs: no velocity may be one of round-off
  for (double& v : p.v) v += 2 * tests::uniform(random) - 1;
  State q = p;
  for (std::size_t body = 0; body < model.bodies.size(); ++body) {
    model.inertia.push_back({1.0 + 0.3 * static_cast<double>(body % 4), 1.0 + static_cast<double>(body % 3)});
  }
  Engine cpu(model, {1}), device(model, Device::device());
  cpu.prepare(p), device.prepare(q);
  advance(cpu, p, 300), advance(device, q, 300);
  EXPECT_GT(cpu.contacts().report(p).live, 4);
  expect_round_off(model, q, p);
}

TEST(CheckedDevice, OrderOfItemsChangesNoByte) {
  const auto model = tests::heap();
  const State start = tests::heap_state(model);
  const State straight = stepped(model, start, options(EngineKind::check, 0), 300);
  for (const std::uint64_t seed : {1, 2}) {
    tests::expect_same_bytes(stepped(model, start, options(EngineKind::check, seed), 300), straight);
  }
  EXPECT_GT(straight.contact.rebuilds, 2);
  EXPECT_TRUE(std::isfinite(largest(straight.a)));
}

TEST(CheckedDevice, OrderOfItemsChangesNoByteOfPadsAndRelaxation) {
  BlockUnderPads block;
  block.model.local_damping = 0.4;
  for (const bool relaxing : {false, true}) {
    if (relaxing) block.model.inertia.assign(1, {2.0, 3.0});
    const auto run = [&](std::uint64_t seed) {
      State state = block.state;
      Engine engine(block.model, options(EngineKind::check, seed));
      engine.set_pad_reference(block.state.x);
      engine.prepare(state);
      engine.advance(state, 2e-7, 50, {std::vector<double>(6, 0.0), std::vector<double>(6, -1e-6)});
      return state;
    };
    const State straight = run(0), permuted = run(3);
    tests::expect_same_bytes(permuted, straight);
    EXPECT_EQ(permuted.pad_force, straight.pad_force);
    EXPECT_GT(largest(straight.v), 0.0);
  }
}

TEST(CheckedDevice, RefusesWhatItDoesNotKnow) {
  const auto refusal = [](const auto& change) -> std::string {
    auto model = tests::heap();
    change(model);
    EXPECT_NO_THROW(Engine(model, options(EngineKind::cpu)));
    try {
      Engine engine(model, options(EngineKind::check));
      return "accepted";
    } catch (const proto::Error& error) {
      EXPECT_EQ(error.code(), proto::ExitCode::config);
      return error.what();
    }
  };
  const auto expect = [&](const char* words, const auto& change) {
    EXPECT_NE(refusal(change).find(words), std::string::npos) << refusal(change);
  };
  const qdem::Bearing mat{1e6, 1e6, 0.0, 0.0, 1e-3};
  EXPECT_EQ(refusal([](qdem::Model&) {}), "accepted");
  expect("contact spheres", [](qdem::Model& model) { model.contact.shape = qdem::ContactShape::sphere; });
  expect("a pad under the sleeper", [&](qdem::Model& model) { model.lining = mat, model.pad_body = 20; });
  expect("ground that gives way", [&](qdem::Model& model) { model.planes[0].bearing = mat; });
  expect("loads on patches", [](qdem::Model& model) {
    model.loads.emplace_back();
    model.loads[0].patch.body = 20;
  });
}

TEST(CheckedDevice, KeepsTheEnergyLedgerClosed) {
  const auto model = tests::heap();
  State state = tests::heap_state(model);
  Engine cpu(model, {1}), device(model, options(EngineKind::check));
  cpu.prepare(state), cpu.open_ledger(state);
  EXPECT_TRUE(cpu.balance(state).open);
  device.advance(state, tests::heap_step, 20);  // flows that it did not count are missing from now on
  EXPECT_FALSE(device.balance(state).open);
  device.open_ledger(state);
  device.advance(state, tests::heap_step, 20);
  const auto balance = device.balance(state);
  EXPECT_FALSE(balance.open);
  EXPECT_EQ(balance.relative(), 0.0);
  EXPECT_GT(balance.stored.kinetic, 0.0);
}

TEST(CudaEngine, IsRefusedWhereItIsNot) {
  const std::string reason = qdem::why_no_cuda();
  if (reason.empty()) GTEST_SKIP() << "there is a CUDA device";
  const auto model = tests::heap();
  try {
    Engine engine(model, options(EngineKind::cuda));
    FAIL() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::unavailable);
    EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
  }
}
