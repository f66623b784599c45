// A bed of a few large stones, built as any bed is: at rest, inside its boundaries, and the same from the cache.
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "qdem_solver/bed/bed.hpp"
#include "qdem_solver/bed/forecast.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using namespace tests;

const char* const small_case = R"(
[track]
gauge_m = 1.435
sleeper_spacing_m = 0.6
[[rail_seat]]
name = "seat"
origin_m = [0.0, 0.7535, 0.0]
longitudinal_axis = [1, 0, 0]
lateral_axis = [0, 1, 0]
half_lengths_m = [0.075, 0.07]
cells = [1, 1]
stiffness_n_per_m = [60e6, 60e6, 225e6]
damping_ns_per_m = [15e3, 15e3, 30e3]
clip_preload_n = 20e3
tension_cutoff = true
[bed]
templates = 4
sleeper_length_m = 1.8
sleeper_cells_through_height = 2
depth_m = 0.24
crib_height_m = 0.0
shoulder_width_m = 0.1
shoulder_slope = 1.0
sieve_sizes_m = [0.14, 0.17]
sieve_passing_percent = [0, 100]
# So few stones are a layer of two: walls rule their porosity.
porosity_limits = [0.3, 0.65]
unbalanced_limit = 0.02
kinetic_energy_limit_j = 0.01
rest_steps = 200000
preload_n = 8e3
)";

qdem::BedPhysics rock() {
  qdem::BedPhysics physics;
  physics.stone = {"stone", 6e10, 0.25, 2700, 0, 0}, physics.sleeper = {"sleeper", 4e10, 0.2, 2400, 0, 0};
  physics.contact.normal_stiffness = 2e7, physics.contact.damping_ratio = 0.05;
  physics.contact.friction = 0.6, physics.contact.rounding = 1e-3;
  return physics;
}

TEST(Bed, IsAtRestInsideItsBoundariesAndCached) {
  const auto folder = std::filesystem::temp_directory_path() / ("small_bed_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "case.toml") << small_case;
  const auto file = proto::CaseFile::load((folder / "case.toml").string());
  const qdem::Bed built = qdem::make_bed(file, rock(), (folder / "cache").string());
  const auto& r = built.report;
  std::printf(
      "%lld stones, porosity under the sleeper %.3f, layer %.3f, coordination %.2f, penetration %.3f mm, "
      "unbalanced %.2e, kinetic %.2e J, %.1f s\n",
      static_cast<long long>(r.stones), r.porosity_under_sleeper, r.porosity_layer, r.coordination_number,
      1e3 * r.largest_penetration, r.unbalanced_force_ratio, r.kinetic_energy, r.build_wall_s);
  EXPECT_FALSE(r.from_cache);
  EXPECT_GT(r.stones, 30);
  EXPECT_LE(r.unbalanced_force_ratio, 0.02);
  EXPECT_LE(r.kinetic_energy, 0.01);
  EXPECT_LE(r.largest_penetration, 0.5e-3);

  // Some of the drawn stones roll off as the formwork goes, none comes; contacts shorten the step.
  const qdem::BedForecast forecast = qdem::forecast_bed(file, rock());
  EXPECT_GE(forecast.stones, r.stones);
  EXPECT_LE(static_cast<double>(forecast.stones), 1.4 * static_cast<double>(r.stones));
  EXPECT_GE(forecast.elements, r.elements);
  qdem::Engine at_rest(built.model);
  qdem::State first = built.state;
  at_rest.prepare(first);
  const double bound = qdem::StepBound(built.model).at(first, at_rest.contacts(), 0.0);
  std::printf("forecast: %lld stones, step bound %.3g s, with contacts %.3g s\n",
              static_cast<long long>(forecast.stones), forecast.stone_step_bound, bound);
  EXPECT_GE(forecast.stone_step_bound, bound);
  EXPECT_LE(forecast.stone_step_bound, 1.5 * bound);

  const qdem::Model& model = built.model;
  for (int b = 1; b < static_cast<int>(model.bodies.size()); ++b) {
    for (int i = 0; i < model.shape(b).n_nodes(); ++i) {
      for (const auto& plane : model.planes) {
        EXPECT_GT(plane.normal.dot(built.state.position(model, b, i) - plane.point), 0) << plane.name << ", body " << b;
      }
      EXPECT_LT(built.state.position(model, b, i)[1], 1.8);
    }
  }
  const qdem::Bed loaded = qdem::make_bed(file, rock(), (folder / "cache").string());
  EXPECT_TRUE(loaded.report.from_cache);
  ASSERT_EQ(built.state.x.size(), loaded.state.x.size());
  EXPECT_EQ(std::memcmp(built.state.x.data(), loaded.state.x.data(), 8 * built.state.x.size()), 0);
  EXPECT_TRUE(built.state.contact.keys == loaded.state.contact.keys);

  // Left alone without any artificial damping it stays where it is.
  qdem::State state = loaded.state;
  qdem::Engine engine(loaded.model);
  engine.prepare(state);
  engine.advance(state, 5e-7, 4000);
  double farthest = 0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    farthest = std::max(farthest, (state.position(model, b, 0) - built.state.position(model, b, 0)).norm());
  }
  std::printf("farthest move in 2 ms: %.2e m\n", farthest);
  EXPECT_LT(farthest, 2e-4);  // a stone that still creeps on the slope
  std::filesystem::remove_all(folder);
}

}  // namespace
