// Rail profiles: shipped ones against their standards, outlines from files, and what is refused.
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

#include "fem_solver/model/section_blocks.hpp"
#include "fem_solver/model/section_warping.hpp"
#include "proto/error.hpp"
#include "tests/support/profile_files.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_rel;

struct Figures {
  const char* name;
  double area, vertical, lateral, mass;  ///< cm2, cm4, kg/m
  friend void PrintTo(const Figures& f, std::ostream* out) { *out << f.name; }
};
class Standard : public ::testing::TestWithParam<Figures> {};

// EN 13674-1 and JIS E 1101.
TEST_P(Standard, area_second_moments_and_mass_within_one_percent) {
  const Figures& f = GetParam();
  const auto section = fem::rail_section(f.name);
  const auto p = section.properties();
  EXPECT_TRUE(near_rel(p.area, f.area * 1e-4, 0.01));
  EXPECT_TRUE(near_rel(p.inertia_vertical, f.vertical * 1e-8, 0.01));
  EXPECT_TRUE(near_rel(p.inertia_lateral, f.lateral * 1e-8, 0.01));
  EXPECT_TRUE(near_rel(p.area * 7850, f.mass, 0.01));
  std::printf("%s: J %.4g m4, shear %.3f vertical, %.3f lateral\n", f.name, section.torsion_constant,
              section.shear_vertical, section.shear_lateral);
  EXPECT_TRUE(near_rel(fem::standard_figures(f.name)->mass, f.mass, 1e-12));
}
INSTANTIATE_TEST_SUITE_P(all, Standard,
                         ::testing::Values(Figures{"60E1", 76.70, 3038.3, 512.3, 60.21},
                                           Figures{"JIS60", 77.50, 3090, 512, 60.8},
                                           Figures{"JIS50N", 64.2, 1960, 322, 50.4}));

// Heights, foot and head of JIS E 1101; the fit keeps them.
TEST(Standard, japanese_rails_have_the_height_and_foot_of_the_drawing) {
  const auto heavy = fem::rail_section("JIS60"), light = fem::rail_section("JIS50N");
  EXPECT_TRUE(near_rel(heavy.head_height, 0.174, 0.003));
  EXPECT_TRUE(near_rel(2 * heavy.foot_half_width, 0.145, 1e-12));
  EXPECT_TRUE(near_rel(light.head_height, 0.153, 0.003));
  EXPECT_TRUE(near_rel(2 * light.foot_half_width, 0.127, 1e-12));
}

class FromFile : public ::testing::TestWithParam<const char*> {};

TEST_P(FromFile, blocks_keep_the_figures_of_a_rounded_outline) {
  const auto points = tests::rounded_outline(fem::rail_section(GetParam()), 3);
  const auto target = fem::RailOutline{points}.properties();
  const auto section = fem::rail_section_from_file(tests::write_profile("round.txt", points));
  const auto p = section.properties();
  std::printf("%s: outline %.2f cm2, torsion %.4g m4\n", GetParam(), target.area * 1e4, section.torsion_constant);
  EXPECT_TRUE(near_rel(p.area, target.area, 1e-8));
  EXPECT_TRUE(near_rel(p.centroid_height, target.centroid_height, 1e-8));
  EXPECT_TRUE(near_rel(p.inertia_vertical, target.inertia_vertical, 1e-8));
  EXPECT_TRUE(near_rel(p.inertia_lateral, target.inertia_lateral, 1e-8));
  // The other way round, shifted: the same blocks.
  auto turned = points;
  std::reverse(turned.begin(), turned.end());
  for (auto& q : turned) q += Eigen::Vector2d(0.3, -0.05);
  const auto again = fem::rail_section_from_file(tests::write_profile("turned.txt", turned));
  for (std::size_t i = 0; i < section.vertices.size(); ++i)
    EXPECT_TRUE((again.vertices[i] - section.vertices[i]).norm() < 1e-9);
}
INSTANTIATE_TEST_SUITE_P(rails, FromFile, ::testing::Values("60E1", "JIS60", "JIS50N"));

struct Wrong {
  const char* name;
  const char* told;
  std::function<std::string(tests::Outline)> write;
  friend void PrintTo(const Wrong& w, std::ostream* out) { *out << w.name; }
};
class Refused : public ::testing::TestWithParam<Wrong> {};

TEST_P(Refused, names_the_fault_and_the_place) {
  const auto path = GetParam().write(tests::rounded_outline(fem::rail_section("60E1"), 1));
  try {
    fem::rail_section_from_file(path);
    FAIL() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().told), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    EXPECT_EQ(error.code(), proto::ExitCode::bad_data);
  }
}

std::string changed(tests::Outline points, const char* name, const std::function<void(Eigen::Vector2d&)>& change) {
  for (auto& p : points) change(p);
  return tests::write_profile(name, points);
}

INSTANTIATE_TEST_SUITE_P(
    all, Refused,
    ::testing::Values(
        Wrong{"open", "is not closed", [](auto p) { return tests::write_profile("open.txt", p, false); }},
        Wrong{"running_surface", "is not closed",
              [](auto p) {
                p.erase(std::remove_if(p.begin(), p.end(), [](auto& q) { return q[1] < 0.15; }), p.end());
                return tests::write_profile("head.txt", p, false);
              }},
        Wrong{"metres", "written in metres",
              [](auto p) { return changed(p, "metres.txt", [](auto& q) { q *= 1e-3; }); }},
        Wrong{"inches", "which no rail is", [](auto p) { return changed(p, "inch.txt", [](auto& q) { q /= 25.4; }); }},
        Wrong{"z_up", "stands on its head", [](auto p) { return changed(p, "up.txt", [](auto& q) { q[1] *= -1; }); }},
        Wrong{"exchanged", "columns exchanged",
              [](auto p) { return changed(p, "swap.txt", [](auto& q) { std::swap(q[0], q[1]); }); }},
        Wrong{"worn", "is not symmetric",
              [](auto p) {
                return changed(p, "worn.txt", [](auto& q) {
                  if (q[1] > .15 && q[0] > .02) q[0] -= .006;
                });
              }},
        Wrong{"knot", "crosses itself",
              [](auto p) {
                std::swap(p[4], p[5]);
                return tests::write_profile("knot.txt", p);
              }},
        Wrong{"bar", "it has no web",
              [](auto) {
                tests::Outline bar;
                for (int i = 0; i < 20; ++i) bar.emplace_back(0.06, 0.0085 * i);
                for (int i = 19; i >= 0; --i) bar.emplace_back(-0.06, 0.0085 * i);
                return tests::write_profile("bar.txt", bar);
              }}),
    [](const auto& wrong) { return std::string(wrong.param.name); });

TEST(Refused, a_line_that_is_not_two_numbers_by_its_number) {
  const std::string path = tests::write_profile("words.txt", tests::rounded_outline(fem::rail_section("60E1"), 1));
  std::ofstream(path, std::ios::app) << "1.0 two\n";
  try {
    fem::rail_section_from_file(path);
    FAIL() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_NE(std::string(error.what()).find("not two numbers"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(path + ":51"), std::string::npos) << error.what();
  }
}

fem::RailSection rectangle(double width, double height) {
  fem::RailSection s;
  s.vertices = {{-width / 2, 0}, {width / 2, 0}, {-width / 2, height}, {width / 2, height}};
  s.quads = {{0, 1, 2, 3}};
  return s;
}

// Timoshenko and Goodier, art. 109: J = 0.229 a b^3 for sides 2:1, 0.1406 a^4 for a square; Timoshenko's 5/6.
TEST(ShearConstants, rectangles) {
  const auto two = fem::shear_constants(rectangle(0.1, 0.2), 24);
  EXPECT_TRUE(near_rel(two.torsion_constant, 0.2287 * 0.2 * 1e-3, 0.005));
  EXPECT_TRUE(near_rel(two.vertical, 5.0 / 6, 0.005));
  EXPECT_TRUE(near_rel(two.lateral, 5.0 / 6, 0.005));
  EXPECT_TRUE(near_rel(fem::shear_constants(rectangle(0.1, 0.1), 24).torsion_constant, 0.1406e-4, 0.005));
}

// Table of rolland for UIC60, which section_60e1() takes over: an independent computation on another outline.
TEST(ShearConstants, uic60_near_the_tabulated_ones) {
  const auto section = fem::rail_section("60E1");
  const auto computed = fem::shear_constants(section);
  std::printf("60E1: J %.4g m4 (table %.4g), kappa %.3f (%.3f), %.3f (%.3f)\n", computed.torsion_constant,
              section.torsion_constant, computed.vertical, section.shear_vertical, computed.lateral,
              section.shear_lateral);
  EXPECT_TRUE(near_rel(computed.torsion_constant, section.torsion_constant, 0.05));
  EXPECT_TRUE(near_rel(computed.vertical, section.shear_vertical, 0.05));
  EXPECT_TRUE(near_rel(computed.lateral, section.shear_lateral, 0.05));
}

}  // namespace
