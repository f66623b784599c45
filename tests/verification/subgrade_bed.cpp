// A bed of a few large stones on a layer of elements: the layer carries it, and what stands on it stays at rest.
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "proto/error.hpp"
#include "proto/result/state_file.hpp"
#include "qdem_solver/bed/bed.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "qdem_solver/output/exchange.hpp"
#include "tests/support/solver_case.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;

class SubgradeBed : public testing::Test {
 protected:
  SubgradeBed() : folder_(std::filesystem::temp_directory_path() / ("subgrade_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "case.toml") << tests::solver_case(
        {{"unbalanced_limit", "1e-5"}, {"kinetic_energy_limit_j", "1e-8"}, {"rest_steps", "100000"}});
  }
  ~SubgradeBed() override { std::filesystem::remove_all(folder_); }

  proto::CaseFile file() const { return proto::CaseFile::load((folder_ / "case.toml").string()); }
  std::string cache() const { return (folder_ / "cache").string(); }

  static qdem::BedPhysics physics(double width = 1.0) {
    qdem::BedPhysics physics;
    physics.stone = {"stone", 1e9, 0.25, 2700, 0, 0}, physics.sleeper = {"sleeper", 1e9, 0.2, 2400, 0, 0};
    physics.contact.normal_stiffness = 1e6, physics.contact.damping_ratio = 0.05;
    physics.contact.friction = 0.6, physics.contact.rounding = 1e-3;
    physics.subgrade = {{"soil", 20e6, 0.3, 1800, 0, 0}, 0.5, width, 0.1};
    return physics;
  }

 private:
  std::filesystem::path folder_;
};

bool same_bytes(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

/// Of the boundary's springs on the layer [N].
Vector3d support(const qdem::Bed& bed) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& particle : bed.model.boundary) {
    const Vector3d u = bed.state.position(bed.model, particle.body, particle.node) - particle.rest;
    sum -= particle.stiffness.cwiseProduct(u);
  }
  return sum;
}

}  // namespace

TEST_F(SubgradeBed, IsCarriedByItsLayerAndStaysAtRest) {
  const qdem::Bed bed = qdem::make_bed(file(), physics(), cache());
  const qdem::Model& model = bed.model;
  const int layer = static_cast<int>(model.bodies.size()) - 1;
  ASSERT_EQ(model.bodies[layer].kind, qdem::BodyKind::ground);

  // Nothing but the layer's boundary carries stones and sleeper: the bay's planes have no friction.
  double weight = 0.0;
  for (int b = 0; b < layer; ++b) weight += 9.81 * model.body_mass(b);
  std::printf("weight %.2f N, on the springs %.2f N; %.0f s of work; unbalanced %.1e\n", weight, support(bed)[2],
              bed.report.build_wall_s, bed.report.unbalanced_force_ratio);
  EXPECT_TRUE(tests::near_rel(support(bed)[2], weight, 5e-3));

  // It gives way: less stiff than on rigid ground, whose bed is in the cache beside it.
  qdem::BedPhysics rigid = physics();
  rigid.subgrade.reset();
  const qdem::Bed base = qdem::make_bed(file(), rigid, cache());
  EXPECT_TRUE(base.report.from_cache);
  EXPECT_EQ(base.report.stones, bed.report.stones);
  EXPECT_EQ(base.report.elements, bed.report.elements);
  EXPECT_NE(base.report.hash, bed.report.hash);
  std::printf("stiffness %.3e N/m, on rigid ground %.3e N/m\n", bed.report.stiffness, base.report.stiffness);
  EXPECT_GT(bed.report.stiffness, 0.0);
  EXPECT_LT(bed.report.stiffness, 0.95 * base.report.stiffness);

  const qdem::Bed loaded = qdem::make_bed(file(), physics(), cache());
  EXPECT_TRUE(loaded.report.from_cache);
  EXPECT_TRUE(same_bytes(bed.state.x, loaded.state.x));
  ASSERT_EQ(bed.model.boundary.size(), loaded.model.boundary.size());
  for (std::size_t i = 0; i < bed.model.boundary.size(); ++i) {
    EXPECT_EQ(bed.model.boundary[i].rest, loaded.model.boundary[i].rest);
    EXPECT_EQ(bed.model.boundary[i].stiffness, loaded.model.boundary[i].stiffness);
    EXPECT_EQ(bed.model.boundary[i].damping, loaded.model.boundary[i].damping);
  }
  EXPECT_EQ(loaded.model.ground_friction, 0.5);

  // Without any artificial damping it stays where it is, and its planes of symmetry stay planes.
  // The rail, which keeps the sleeper from moving along the track, is missing.
  qdem::Model under_rail = loaded.model;
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) under_rail.fixities.push_back({0, i, 1u});
  qdem::State state = loaded.state;
  qdem::Engine engine(under_rail, {1});
  engine.prepare(state);
  engine.open_ledger(state);
  const double dt = 0.8 * qdem::StepBound(under_rail).at(state, engine.contacts(), 1e-4);
  engine.advance(state, dt, static_cast<std::int64_t>(0.02 / dt));
  double farthest = 0.0;
  for (int b = 0; b <= layer; ++b) {
    farthest = std::max(farthest, (state.position(model, b, 0) - bed.state.position(model, b, 0)).norm());
  }
  for (const auto& held : loaded.model.fixities) {
    if (held.body != layer) continue;
    const Vector3d moved = state.position(model, layer, held.node) - bed.state.position(model, layer, held.node);
    for (int c = 0; c < 2; ++c) EXPECT_EQ((held.mask >> c & 1u) * moved[c], 0.0);
  }
  std::printf("farthest move in 20 ms: %.2e m; step %.2e s\n", farthest, dt);
  EXPECT_LT(farthest, 1e-5);

  // A checkpoint holds all of it, with the layer under way.
  for (double& v : state.v) v += 1e-3;
  engine.advance(state, dt, 100);
  EXPECT_GT(state.ledger.radiated, 0.0);
  const std::string path = cache() + "/checkpoint.h5";
  proto::StateWriter writer;
  qdem::exchange(writer, "state/", state);
  proto::StateReader reader(path, writer.write(path));
  qdem::State restored = loaded.state;
  qdem::exchange(reader, "state/", restored);
  engine.advance(state, dt, 100);
  qdem::Engine two_threads(under_rail, {2});
  two_threads.advance(restored, dt, 100);
  EXPECT_TRUE(same_bytes(state.x, restored.x));
  EXPECT_TRUE(same_bytes(state.v, restored.v));
  EXPECT_EQ(state.ledger.radiated, restored.ledger.radiated);
  EXPECT_EQ(state.ledger.start.boundary, restored.ledger.start.boundary);
}

TEST_F(SubgradeBed, ALayerThatEndsUnderTheBedIsRefused) {
  try {
    qdem::check_bed(file(), physics(0.3));
    FAIL() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::config);
    EXPECT_NE(std::string(error.what()).find("the layer ends 0.3 m from the track's centre"), std::string::npos)
        << error.what();
  }
}

TEST_F(SubgradeBed, ElementsTooCoarseForTheWantedFrequencyAreToldWithFigures) {
  qdem::BedPhysics wanted = physics();
  EXPECT_TRUE(qdem::check_bed(file(), wanted).empty());
  // c_s = sqrt(20e6/2.6/1800) = 65.37 m/s: ten bricks of 0.1 m on a wave at 65.4 Hz.
  wanted.subgrade->highest_frequency = 65.0;
  EXPECT_TRUE(qdem::check_bed(file(), wanted).empty());
  wanted.subgrade->highest_frequency = 130.74;
  const auto warnings = qdem::check_bed(file(), wanted);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("0.1 m resolve 65.4 Hz"), std::string::npos) << warnings[0];
  EXPECT_NE(warnings[0].find("want 0.05 m"), std::string::npos) << warnings[0];
}
