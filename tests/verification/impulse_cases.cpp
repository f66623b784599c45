// The expected values of the cases stone_impulse and sleeper_impulse are those of linear models on the same meshes.
#include <gtest/gtest.h>

#include "qdem_solver/bed/lone_body.hpp"
#include "qdem_solver/participant/qdem_case.hpp"
#include "tests/support/free_modes.hpp"
#include "tests/support/tapered_beam.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;
using qdem::bed::Scene;
using tests::near_rel;

constexpr double printed = 1e-3;  // precision to which expected.toml holds the models' values

const std::string cases = HOUSE_SOURCE_DIR "/cases/";

/// Column "frequency" of the expected values of a run, in the order of the file [Hz].
std::vector<double> expected_frequencies(const std::string& name, const std::string& run) {
  std::vector<double> values;
  const auto file = proto::CaseFile::load(cases + name + "/expected.toml");
  for (const auto& table : file.sections("run")) {
    if (table.text_or("name", "") != run) continue;
    for (const auto& expected : table.sections("expected")) {
      if (expected.text("column") == "frequency") values.push_back(expected.number("value"));
    }
  }
  return values;
}

/// One body of a case, under the gravity given.
struct LoneScene {
  qdem::BedPhysics physics;
  qdem::Bed bed;

  LoneScene(const std::string& name, Scene scene, double gravity) {
    const auto file = proto::CaseFile::load(cases + name + "/case.toml");
    physics = qdem::read_qdem_case(file).physics;
    physics.gravity = Vector3d(0, 0, -gravity);
    auto settings = qdem::bed::read_settings(file);
    settings.scene = scene;
    bed = qdem::bed::lone_body(settings, physics);
  }

  std::vector<Vector3d> nodes(int body) const {
    std::vector<Vector3d> result;
    for (int i = 0; i < bed.model.shape(body).n_nodes(); ++i) {
      result.push_back(bed.state.position(bed.model, body, i));
    }
    return result;
  }

  tests::LinearFem linear_model(int body) const {
    return tests::LinearFem(nodes(body), bed.model.shape(body).tets, bed.model.material(body));
  }
};

void add_spring(tests::LinearFem& fem, int node, const Vector3d& stiffness) {
  for (int c = 0; c < 3; ++c) fem.stiffness.coeffRef(3 * node + c, 3 * node + c) += stiffness[c];
}

void expect_modes(const std::vector<tests::Mode>& modes, const std::vector<double>& expected) {
  ASSERT_GE(modes.size(), expected.size());
  ASSERT_FALSE(expected.empty());
  for (std::size_t m = 0; m < modes.size(); ++m) {
    std::printf("mode %zu: %.1f Hz\n", m + 1, modes[m].frequency);
    if (m < expected.size()) {
      EXPECT_TRUE(near_rel(expected[m], modes[m].frequency, printed)) << "mode " << m + 1;
    }
  }
}

}  // namespace

TEST(StoneImpulse, AFreeStoneHasTheModesOfItsMesh) {
  const LoneScene scene("stone_impulse", Scene::stone, 0.0);
  expect_modes(tests::lowest_modes(scene.linear_model(1), 6, 6, 40e3), expected_frequencies("stone_impulse", "free"));
}

/// Contact points are springs on the particles that touch the ground.
TEST(StoneImpulse, AStoneOnTheGroundRattlesOnItsContactSprings) {
  const LoneScene scene("stone_impulse", Scene::stone, 9.81);
  auto fem = scene.linear_model(1);
  const auto& contact = scene.physics.contact;
  const double ground = scene.bed.model.planes.front().point[2];
  int n_touching = 0;
  for (const int node : scene.bed.model.shape(1).surface_nodes) {
    if (scene.nodes(1)[node][2] - contact.rounding >= ground) continue;
    add_spring(fem, node, contact.normal_stiffness * Vector3d(contact.tangential_ratio, contact.tangential_ratio, 1.0));
    ++n_touching;
  }
  std::printf("%d contact points\n", n_touching);
  ASSERT_GE(n_touching, 3);
  expect_modes(tests::lowest_modes(fem, 0, 6, 2e3), expected_frequencies("stone_impulse", "lying"));
}

/// Beam theory stands beside: the mesh is four bricks high, and linear tetrahedra lock in bending.
TEST(SleeperImpulse, AFreeSleeperHasTheModesOfItsMesh) {
  const LoneScene scene("sleeper_impulse", Scene::sleeper, 0.0);
  auto fem = scene.linear_model(0);
  const auto nodes = scene.nodes(0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {  // symmetry: no motion across the cut
    if (nodes[i][1] < 1e-9) add_spring(fem, static_cast<int>(i), Vector3d(0, 1e14, 0));
  }
  const auto expected = expected_frequencies("sleeper_impulse", "free");
  ASSERT_EQ(expected.size(), 2u);
  std::vector<tests::Mode> bending;
  for (const auto& mode : tests::lowest_modes(fem, 3, 6, 300.0)) {
    double along_z = 0.0, along_x = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      along_z += fem.mass[3 * i] * std::pow(mode.shape[i][2], 2);
      along_x += fem.mass[3 * i] * std::pow(mode.shape[i][0], 2);
    }
    if (along_z > 4 * along_x) bending.push_back(mode);
  }
  bending.resize(std::min<std::size_t>(bending.size(), 2));
  expect_modes(bending, expected);
  const auto section = [](double) { return tests::BeamSection::trapezoid(0.2, 0.26, 0.26); };
  for (const int mode : {1, 3}) {
    const double beam = tests::free_bending(section, 1.9, {46.3e9, 0.2, 2440}, mode);
    const double on_mesh = expected[mode / 2];
    std::printf("Timoshenko beam, mode %d: %.1f Hz, the mesh %+.1f %%\n", mode, beam, 100 * (on_mesh / beam - 1));
    EXPECT_TRUE(on_mesh > beam && on_mesh < 1.25 * beam);
  }
}
