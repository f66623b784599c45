// Bad input, one at a time, through the real programs: one message that names the place and the culprit, the exit code
// of its kind, no process left, nothing written that looks like a result.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "proto/case/case_file.hpp"
#include "proto/error.hpp"
#include "qdem_solver/output/bed_file.hpp"
#include "qdem_solver/participant/qdem_case.hpp"
#include "tests/support/coupled_run.hpp"
#include "tests/support/solver_case.hpp"

namespace {

using proto::ExitCode;
using tests::contains;
using tests::CoupledRun;

const std::string beds = HOUSE_BIN_DIR "/../test_beds";

struct BadInput {
  const char* name;
  tests::CaseChanges changes;  ///< of solver_case()
  ExitCode code;
  const char* culprit;              ///< in summary.json; "": refused before a run began
  std::vector<std::string> told{};  ///< parts of the message
  friend void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }
};

const BadInput bad_inputs[] = {
    {"typo_in_a_bed_key",
     {{"templates", "2\ntemplate = 2"}},
     ExitCode::config,
     "qdem",
     {"unknown key - ", "case.toml:37:1: bed.template - did you mean 'templates'?"}},
    {"typo_in_a_qdem_key",
     {{"threads", "1\nthread = 1"}},
     ExitCode::config,
     "qdem",
     {"unknown key - ", "qdem.thread - did you mean 'threads'?"}},
    {"typo_in_a_fem_key",
     {{"n_bays", "4\nn_bay = 4"}},
     ExitCode::config,
     "fem",
     {"unknown key - ", "fem.n_bay - did you mean 'n_bays'?"}},
    {"typo_in_a_wheel_key",
     {{"radius_m", "0.43\nradius = 0.43"}},
     ExitCode::config,
     "fem",
     {"unknown key - ", "wheel.radius - did you mean 'radius_m'?"}},
    {"negative_pad_stiffness",
     {{"stiffness_n_per_m", "[6e6, 6e6, -20e6]"}},
     ExitCode::config,
     "",
     {"the value must be at least 0, found -2e+07", "case.toml:23:32: rail_seat.stiffness_n_per_m[2]"}},
    {"negative_modulus",
     {{"young_pa", "-1e9"}},
     ExitCode::config,
     "qdem",
     {"the value must be greater than 0, found -1e+09", "qdem.material.young_pa"}},
    {"negative_contact_stiffness",
     {{"normal_stiffness_n_per_m", "-1e6"}},
     ExitCode::config,
     "qdem",
     {"the value must be greater than 0", "qdem.contact.normal_stiffness_n_per_m"}},
    {"negative_friction",
     {{"friction", "-0.1"}},
     ExitCode::config,
     "qdem",
     {"must be between 0 and 2, found -0.1", "qdem.contact.friction"}},
    {"negative_rolling_friction",
     {{"friction", "0.6\nlaw = \"sphere\"\nrolling_friction = -0.1"}},
     ExitCode::config,
     "qdem",
     {"must be between 0 and 2, found -0.1", "qdem.contact.rolling_friction"}},
    {"rolling_friction_of_facets",
     {{"friction", "0.6\nrolling_friction = 0.1"}},
     ExitCode::config,
     "qdem",
     {"it is for contact spheres, and the law is \"facet\"", "qdem.contact.rolling_friction"}},
    {"negative_support_stiffness",
     {{"element_length_m", "0.38\n[fem.support]\nballast_stiffness_n_per_m = [5e7, -5e7, 5e7]"}},
     ExitCode::config,
     "fem",
     {"the value must be at least 0", "fem.support.ballast_stiffness_n_per_m[1]"}},
    {"load_that_is_not_a_number",
     {{"static_load_n", "nan"}},
     ExitCode::config,
     "fem",
     {"a finite number is wanted, found nan", "wheel.static_load_n"}},
    {"missing_irregularity_table",
     {{"radius_m", "0.43\n[wheel.irregularity]\nkind = \"table\"\nfile = \"nowhere.csv\""}},
     ExitCode::missing_input,
     "fem",
     {"there is no file '", "/nowhere.csv'", "wheel.irregularity.file"}},
    {"irregularity_table_that_is_none",
     {{"radius_m", "0.43\n[wheel.irregularity]\nkind = \"table\"\nfile = \"case.toml\""}},
     ExitCode::bad_data,
     "fem",
     {"a line of the irregularity table is not two numbers 'x_m, height_m'", "case.toml:1"}},
    {"profile_file_that_is_none",
     {{"n_bays", "4\nprofile_file = \"case.toml\""}},
     ExitCode::bad_data,
     "fem",
     {"a line of the rail profile is not two numbers 'y_mm, z_mm'", "case.toml:1"}},
    {"wheel_heavier_than_the_unsprung_mass",
     {{"radius_m", "0.43\nmodel = \"solid\""}},
     ExitCode::bad_data,
     "fem",
     {"the solid wheel weighs ", "more than the unsprung mass", "[wheel] unsprung_mass_kg"}},
    {"flat_longer_than_the_wheel",
     {{"radius_m", "0.43\n[wheel.defect]\nkind = \"fresh_flat\"\nlength_m = 0.3\nposition_m = 0.0"}},
     ExitCode::config,
     "fem",
     {"the value must be greater than 0 and at most 0.215, found 0.3", "wheel.defect.length_m"}},
    {"pad_that_softens",
     {{"element_length_m", "0.38\n[fem.support]\npad_second_stiffness_n_per_m = 1e6"}},
     ExitCode::config,
     "fem",
     {"the pad would soften when pressed", "fem.support.pad_second_stiffness_n_per_m"}},
    {"unknown_profile",
     {{"n_bays", "4\nprofile = \"60E2\""}},
     ExitCode::config,
     "fem",
     {"'60E2' is not one of: 60E1", "fem.profile - did you mean '60E1'?"}},
    {"damping_given_twice",
     {{"retardation_time_s", "1e-6\nloss_factor = 0.01"}},
     ExitCode::config,
     "qdem",
     {"viscosity is given twice", "qdem.material.retardation_time_s"}},
    {"stones_from_files_and_generated",
     {{"templates", "2\nstone_files = \"*.stl\""}},
     ExitCode::config,
     "qdem",
     {"it is for generated stones, and stone_files gives stones", "bed.templates"}},
    {"step_above_the_bound",
     {{"threads", "1\nlargest_step_s = 1e-3"}},
     ExitCode::config,
     "qdem",
     {"0.001 s is above the stability bound of ", "qdem.largest_step_s - lower it"}},
    {"seat_beyond_the_sleeper",
     {{"origin_m", "[0.0, 0.18, 0.0]"}},
     ExitCode::config,
     "qdem",
     {"rail seat 'seat' ends ", "beyond the end of the sleeper"}},
    {"seat_between_the_sleepers",
     {{"origin_m", "[0.1, 0.1, 0.0]"}},
     ExitCode::config,
     "fem",
     {"rail seat 'seat' does not lie at a multiple of the sleeper spacing"}},
    {"wheel_off_the_rail",
     {{"start_m", "10.0"}},
     ExitCode::config,
     "fem",
     {"the wheel at x = 10.000000 m", "wheel.start_m"}},
};

/// What a run that failed before its first window leaves.
void expect_refusal(CoupledRun& run, ExitCode code, const std::string& culprit, const std::vector<std::string>& told) {
  EXPECT_EQ(run.n_processes(), 0);
  const auto message = run.message();
  EXPECT_EQ(message.find("coupler: "), 0u) << message;
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
  for (const auto& part : told) EXPECT_TRUE(contains(message, part)) << part << "\n" << message;
  EXPECT_EQ(std::filesystem::exists(run.out()), !culprit.empty());
  if (culprit.empty()) return;
  const auto failure = run.summary()["failure"];
  EXPECT_EQ(run.summary()["status"], "failed");
  EXPECT_EQ(failure["culprit"], culprit);
  EXPECT_EQ(failure["exit_code"], static_cast<int>(code));
  EXPECT_EQ("coupler: " + failure["message"].get<std::string>() + "\n", message);
  for (const char* name : {"coupling.h5", "qdem.h5"}) EXPECT_FALSE(std::filesystem::exists(run.out() + "/" + name));
}

class SolverBadInput : public ::testing::Test {
 protected:
  SolverBadInput() { setenv("QDEM_BED_CACHE", beds.c_str(), 1); }
};

class SolverBadCase : public SolverBadInput, public ::testing::WithParamInterface<BadInput> {};

TEST_P(SolverBadCase, IsNamed) {
  const auto& input = GetParam();
  CoupledRun run(tests::solver_case(input.changes));
  run.start();
  EXPECT_EQ(run.wait(120.0).value_or(-1), static_cast<int>(input.code)) << run.message();
  expect_refusal(run, input.code, input.culprit, input.told);
}

INSTANTIATE_TEST_SUITE_P(Of, SolverBadCase, ::testing::ValuesIn(bad_inputs),
                         [](const auto& test) { return std::string(test.param.name); });

struct BadStone {
  const char* name;
  const char* file;     ///< beside the case
  const char* content;  ///< of it
  const char* pattern;  ///< of the case
  ExitCode code;
  std::vector<std::string> told;
  friend void PrintTo(const BadStone& stone, std::ostream* out) { *out << stone.name; }
};

const char* const one_facet =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid "
    "a\n";
/// Two tetrahedra that share a face, of which the second is inverted.
const char* const inverted_mesh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n"
    "$Elements\n2\n41 4 2 1 1 1 2 3 4\n42 4 2 1 1 3 2 4 5\n$EndElements\n";

const BadStone bad_stones[] = {
    {"no_stone_file", "a.stl", one_facet, "b*.stl", ExitCode::missing_input, {"there is no file '", "bed.stone_files"}},
    {"no_stone_in_the_folder",
     "a.txt",
     "",
     ".",
     ExitCode::missing_input,
     {"has no file that ends on one of: .msh, .stl, .obj", "bed.stone_files"}},
    {"stone_file_of_another_kind",
     "a.ply",
     "ply\n",
     "a.ply",
     ExitCode::config,
     {"/a.ply' ends on none of: .msh, .stl, .obj", "bed.stone_files"}},
    {"stone_file_that_is_none",
     "a.stl",
     "hello\n",
     "a.stl",
     ExitCode::bad_data,
     {"it is not a whole surface in the format STL", "/a.stl"}},
    {"open_stone", "a.stl", one_facet, "a.stl", ExitCode::bad_data, {"the surface is open: 3 edges", "/a.stl"}},
    {"inverted_tetrahedron",
     "a.msh",
     inverted_mesh,
     "a.msh",
     ExitCode::bad_data,
     {"1 inverted or flat tetrahedra: 42 (volume -", "/a.msh"}},
};

/// The case with stones from files, which excludes the number of generated ones.
std::string case_of_stones(const std::string& pattern) {
  auto text = tests::solver_case({{"seed", "1\nstone_files = \"" + pattern + "\""}});
  const std::string generated = "templates = 2\n";
  return text.erase(text.find(generated), generated.size());
}

class SolverBadStone : public SolverBadInput, public ::testing::WithParamInterface<BadStone> {};

TEST_P(SolverBadStone, IsNamed) {
  const auto& stone = GetParam();
  CoupledRun run(case_of_stones(stone.pattern));
  std::ofstream(std::filesystem::path(run.case_path()).replace_filename(stone.file)) << stone.content;
  run.start();
  EXPECT_EQ(run.wait(60.0).value_or(-1), static_cast<int>(stone.code)) << run.message();
  expect_refusal(run, stone.code, "qdem", stone.told);
}

INSTANTIATE_TEST_SUITE_P(Of, SolverBadStone, ::testing::ValuesIn(bad_stones),
                         [](const auto& test) { return std::string(test.param.name); });

/// Name of the file of the case's bed, which is built if no test before did.
std::string bed_file() {
  CoupledRun run(tests::solver_case({{"duration_s", "1e-4"}}));
  run.start();
  EXPECT_EQ(run.wait(120.0).value_or(-1), 0) << run.message();
  return run.summary()["bed"]["hash"].get<std::string>() + ".h5";
}

TEST_F(SolverBadInput, AnInvertedElementOfTheBedIsNamed) {
  const auto name = bed_file();
  const tests::TemporaryFolder cache;
  setenv("QDEM_BED_CACHE", cache.path().c_str(), 1);
  CoupledRun run(tests::solver_case());
  const auto physics = qdem::read_qdem_case(proto::CaseFile::load(run.case_path())).physics;
  auto bed = qdem::read_bed_file(beds + "/" + name, physics);
  std::swap(bed.model.templates[1].tets[7][0], bed.model.templates[1].tets[7][1]);
  qdem::write_bed_file(cache.file(name), bed);
  run.start();
  EXPECT_EQ(run.wait(30.0).value_or(-1), static_cast<int>(ExitCode::bad_data)) << run.message();
  expect_refusal(run, ExitCode::bad_data, "qdem",
                 {"1 inverted or flat tetrahedra: 7 (volume ", cache.file(name), "delete it"});
}

}  // namespace
