// The bed file: what is written comes back to the bit.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "proto/error.hpp"
#include "qdem_solver/bed/sleeper_shape.hpp"
#include "qdem_solver/contact/contact_stage.hpp"
#include "qdem_solver/output/bed_file.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using namespace tests;
using namespace qdem::bed;
using Eigen::Vector3d;

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

qdem::Bed two_cubes(const qdem::BedPhysics& physics) {
  qdem::Bed bed;
  bed.model.materials = {physics.stone, physics.sleeper};
  bed.model.contact = physics.contact;
  bed.model.templates.push_back(box_shape("cube", Vector3d::Constant(-0.05), Vector3d::Constant(0.05), 0.05));
  bed.model.bodies.resize(2);
  bed.model.bodies[0].kind = qdem::BodyKind::sleeper, bed.model.bodies[0].name = "sleeper";
  bed.model.bodies[0].material_id = 1;
  bed.model.bodies[1].scale = 0.9, bed.model.bodies[1].name = "stone_1";
  bed.model.planes.push_back({"ground", {0, 0, -0.05}, Vector3d::UnitZ(), Vector3d::Zero(), 0.5, true, true});
  bed.model.fixities.push_back({0, 3, 2u});
  make_batches(bed.model);
  bed.state = make_state(bed.model, {{}, {Eigen::Matrix3d::Identity(), {0.01, 0, 0.096}}});
  for (std::size_t i = 0; i < bed.state.v.size(); ++i) bed.state.v[i] = 1e-3 * std::sin(double(i));
  qdem::ContactStage stage(bed.model);
  stage.update_candidates(bed.state);
  stage.compute(bed.state, 1e-6);
  bed.report.hash = "0123456789abcdef", bed.report.stones = 1, bed.report.porosity_layer = 0.41;
  bed.report.notes = {"a note", "another"};
  return bed;
}

TEST(BedFile, RoundTripIsBitwise) {
  qdem::BedPhysics physics;
  physics.stone = {"stone", 6e10, 0.25, 2700, 0, 0}, physics.sleeper = {"sleeper", 4e10, 0.2, 2400, 0, 0};
  physics.contact.normal_stiffness = 1e6, physics.contact.friction = 0.5, physics.contact.rounding = 1e-3;
  physics.ground.normal_stiffness = 2e6, physics.lining.normal_stiffness = 3e6;
  const qdem::Bed bed = two_cubes(physics);
  ASSERT_GT(bed.state.contact.keys.size(), 4u);
  const auto folder = std::filesystem::temp_directory_path() / ("bed_file_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string path = (folder / "bed.h5").string();
  write_bed_file(path, bed);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);  // no draft is left
  const qdem::Bed read = qdem::read_bed_file(path, physics);
  EXPECT_TRUE(same_bytes(bed.state.x, read.state.x));
  EXPECT_TRUE(same_bytes(bed.state.v, read.state.v));
  EXPECT_TRUE(same_bytes(bed.state.a, read.state.a));
  EXPECT_TRUE(bed.state.contact.keys == read.state.contact.keys);
  EXPECT_TRUE(same_bytes(bed.state.contact.slip, read.state.contact.slip));
  EXPECT_EQ(bed.state.contact.triangles, read.state.contact.triangles);
  EXPECT_EQ(bed.state.contact.triangle_offsets, read.state.contact.triangle_offsets);
  EXPECT_EQ(bed.state.contact.list_id, read.state.contact.list_id);
  EXPECT_EQ(bed.state.contact.travel, read.state.contact.travel);
  EXPECT_EQ(bed.model.n_values, read.model.n_values);
  EXPECT_EQ(bed.model.planes[0].point, read.model.planes[0].point);
  EXPECT_EQ(read.model.planes[0].bearing.normal_stiffness, 2e6);
  EXPECT_EQ(read.model.lining.normal_stiffness, 3e6);
  EXPECT_EQ(bed.model.templates[0].triangles.size(), read.model.templates[0].triangles.size());
  EXPECT_EQ(bed.report.porosity_layer, read.report.porosity_layer);
  EXPECT_EQ(bed.report.notes, read.report.notes);

  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THROW(qdem::read_bed_file(path, physics), proto::Error);
  std::filesystem::remove_all(folder);
}

TEST(BedFile, KeepsTheRollOfSpheres) {
  qdem::BedPhysics physics;
  physics.stone = {"stone", 6e10, 0.25, 2700, 0, 0}, physics.sleeper = {"sleeper", 4e10, 0.2, 2400, 0, 0};
  physics.contact.normal_stiffness = 1e6, physics.contact.friction = 0.5, physics.contact.rounding = 3e-2;
  physics.contact.shape = qdem::ContactShape::sphere, physics.contact.rolling_friction = 0.2;
  const qdem::Bed bed = two_cubes(physics);
  ASSERT_GT(bed.state.contact.roll.size(), 4u);
  const auto path =
      (std::filesystem::temp_directory_path() / ("spheres_" + std::to_string(::getpid()) + ".h5")).string();
  write_bed_file(path, bed);
  EXPECT_TRUE(same_bytes(bed.state.contact.roll, qdem::read_bed_file(path, physics).state.contact.roll));
  std::filesystem::remove(path);
}

}  // namespace
