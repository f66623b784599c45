// coupler analyze on the files of a small real run, and on runs that lack records.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "coupler/record/coupling_record.hpp"
#include "coupler/study/analyses.hpp"
#include "coupler/study/stone_mesh.hpp"
#include "proto/result/field_series.hpp"
#include "qdem_solver/participant/run_alone.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/small_bed.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using namespace coupler::study;
using tests::near_abs;
using tests::near_rel;
namespace fs = std::filesystem;

const char* const qdem_keys = R"(threads = 1
sensor_interval_s = 1e-4
contact_output = true
[qdem.run]
duration_s = 0.06
output_interval_s = 2e-3
[[qdem.run.load]]
kind = "half_sine"
peak_n = 4000
duration_s = 8e-3
start_s = 20e-3
[[qdem.sensor]]
name = "layer"
kind = "stones"
[[qdem.sensor]]
name = "sleeper"
kind = "bottom"
cells = [3, 4]
[[qdem.sensor]]
name = "cells"
kind = "pressure"
cells = [3, 4]
[[qdem.sensor]]
name = "deep"
kind = "stone"
point_m = [-0.05, 0.65, -0.2]
)";

/// The run that all tests look at, made once.
const std::string& run_folder() {
  static const tests::TemporaryFolder folder;
  static const std::string path = [] {
    const auto file = proto::CaseFile::load(tests::small_bed_case(folder.path(), qdem_keys));
    qdem::run_alone(file, tests::small_bed, folder.path(), {}, [](const std::string& line) { ADD_FAILURE() << line; });
    return folder.path();
  }();
  return path;
}

const Table& table(const Findings& findings, const std::string& name) {
  for (const auto& candidate : findings.tables) {
    if (candidate.name == name) return candidate;
  }
  throw std::runtime_error("no table " + name);
}

const std::vector<double>& column(const Findings& findings, const std::string& name, const std::string& column) {
  for (const auto& candidate : table(findings, name).columns) {
    if (candidate.name == column) return candidate.values;
  }
  throw std::runtime_error("no column " + column);
}

double figure(const Findings& findings, const std::string& group, const std::string& name) {
  for (const auto& candidate : findings.figures) {
    if (candidate.group.rfind(group, 0) == 0 && candidate.name.rfind(name, 0) == 0) return candidate.value;
  }
  throw std::runtime_error("no figure " + group + ": " + name);
}

bool notes(const Findings& findings, const std::string& part) {
  for (const auto& note : findings.notes) {
    if (note.find(part) != std::string::npos) return true;
  }
  return false;
}

TEST(AnalysisOfARun, FindsTheBlow) {
  const auto findings = analyse(run_folder(), {});
  const double peak = figure(findings, "load", "largest"), at = figure(findings, "load", "at");
  EXPECT_GT(peak, 4000.0) << "force of the blow, and the sleeper's weight and inertia";
  EXPECT_TRUE(near_abs(at, 24e-3, 8e-3));
  // What presses on the bottom is what the cells carry.
  const double area = 0.3 * 0.4;
  EXPECT_TRUE(near_rel(figure(findings, "pressure under the sleeper", "mean") * area, peak, 1e-9));
  EXPECT_GE(figure(findings, "pressure under the sleeper", "largest over mean"), 1.0);
  EXPECT_GT(figure(findings, "stress in the stones", "over the mean pressure"), 1.0);
  EXPECT_TRUE(near_rel(figure(findings, "stress in the stones", "mean size"),
                       std::cbrt(std::sqrt(2.0) * 0.03 * 0.03 * 0.03), 1e-9));
}

TEST(AnalysisOfARun, TransferIsThatOfTheRecords) {
  Options options;
  options.n_bins = 1, options.segment = 0.02;
  const auto findings = analyse(run_folder(), options);
  EXPECT_EQ(column(findings, "transfer_bands", "stones")[0], 12.0);
  EXPECT_EQ(figure(findings, "T(f,z)", "T(f,z): averages"), 5.0);  // 601 samples, 200 in a segment, half of them shared
  EXPECT_TRUE(near_rel(figure(findings, "T(f,z)", "T(f,z): resolution"), 50.0, 1e-9));
  EXPECT_TRUE(notes(findings, "the record is 0.0601 s: resolution 50 Hz"));
  // From the records themselves, at one line and with sums written out.
  const RunFiles files(run_folder());
  const auto stones = *files.stones(), bottom = *files.bottom();
  const auto power = [](const coupler::analysis::Motion& motion, std::size_t point, std::size_t line) {
    const auto v = motion.history(motion.velocity, point, 2);
    double sum = 0.0;
    for (std::size_t s = 0; s < 5; ++s) {
      double mean = 0.0;
      for (std::size_t i = 0; i < 200; ++i) mean += v[100 * s + i] / 200;
      std::complex<double> x = 0.0;
      for (std::size_t i = 0; i < 200; ++i) {
        const double angle = 2 * M_PI * static_cast<double>(i) / 200;
        x +=
            0.5 * (1 - std::cos(angle)) * (v[100 * s + i] - mean) * std::polar(1.0, -angle * static_cast<double>(line));
      }
      sum += std::norm(x);
    }
    return sum;
  };
  for (const std::size_t line : {1u, 3u}) {
    double reference = 0.0, expected = 0.0;
    for (std::size_t cell = 0; cell < 12; ++cell) reference += power(bottom, cell, line) / 12;
    for (std::size_t stone = 0; stone < 12; ++stone) expected += std::sqrt(power(stones, stone, line) / reference) / 12;
    EXPECT_TRUE(near_rel(column(findings, "transfer", "bin_1")[line], expected, 1e-9)) << line;
  }
  EXPECT_GT(column(findings, "attenuation", "vertical_over_bottom")[0], 0.0);
}

TEST(AnalysisOfARun, OutputsOfTheFieldsGiveTheSameDisplacements) {
  const auto from_sensor = analyse(run_folder(), {});
  const tests::TemporaryFolder without_sensors;
  fs::copy_file(run_folder() + "/qdem.h5", without_sensors.file("qdem.h5"));
  EXPECT_TRUE(notes(analyse(without_sensors.path(), {}), "displacement field: no load is known"));
  const RunFiles files(run_folder());
  const auto stones = *files.stones();
  const StoneMesh mesh(*files.qdem());
  ASSERT_EQ(mesh.n_stones(), 12u);
  const auto displacement = mesh.displacement(*files.qdem(), 12);  // at 0.024 s
  for (std::size_t i = 0; i < displacement.size(); ++i) {
    EXPECT_TRUE(near_abs(mesh.places()[i / 3][i % 3], stones.place[i / 3][i % 3], 1e-12));
    EXPECT_TRUE(near_abs(displacement[i], stones.displacement[240 * 36 + i], 1e-9)) << "float32";
  }
  const auto& vertical = column(from_sensor, "displacement_field", "vertical");
  EXPECT_LT(*std::min_element(vertical.begin(), vertical.end()), 0.0);
  EXPECT_EQ(vertical.size(), 12u);
}

TEST(AnalysisOfARun, ContactsAndEnergiesAreThere) {
  const auto findings = analyse(run_folder(), {});
  const auto& pairs = column(findings, "contacts", "pairs");
  EXPECT_EQ(pairs.size(), 31u);
  EXPECT_EQ(figure(findings, "contacts", "pairs"), 24.0);  // every stone between sleeper and ground, at the peak
  EXPECT_EQ(figure(findings, "contacts", "coordination"), 1.0);
  EXPECT_GE(figure(findings, "contacts", "share of the pairs that are lost"), 0.0);
  const auto& kinetic = column(findings, "energies", "kinetic_energy");
  EXPECT_EQ(kinetic.size(), 31u);
  EXPECT_GT(*std::max_element(kinetic.begin(), kinetic.end()), 0.0);
  EXPECT_FALSE(table(findings, "modes_bottom").columns.empty());
  EXPECT_EQ(column(findings, "history_sensor_deep", "time").size(), 601u);
}

TEST(AnalysisOfARunThatWasStopped, GoesOnWithOneSample) {
  const tests::TemporaryFolder folder;
  proto::Attributes attributes = {{"layer.kind", std::string("stones")}, {"sleeper.kind", std::string("bottom")}};
  for (const char* side : {"x_min_m", "y_min_m", "z_m"}) attributes.emplace_back(std::string("sleeper.") + side, 0.0);
  for (const char* side : {"x_max_m", "y_max_m"}) attributes.emplace_back(std::string("sleeper.") + side, 1.0);
  auto file = proto::TimeSeriesFile::create(folder.file("sensors.h5"),
                                            {{"time", "s", "", {}},
                                             {"layer/position", "m", "", {1, 3}},
                                             {"layer/velocity", "m/s", "", {1, 3}},
                                             {"sleeper/displacement", "m", "", {1, 1, 3}},
                                             {"sleeper/velocity", "m/s", "", {1, 1, 3}}},
                                            attributes);
  const std::vector<double> below = {0.5, 0.5, -0.1};
  file.put("time", 0.0), file.put("layer/position", below);
  for (const char* name : {"layer/velocity", "sleeper/displacement", "sleeper/velocity"}) file.put(name, below);
  file.end_row();
  file.close();
  Options options;
  options.segment = 0.1;
  const auto findings = analyse(folder.path(), options);
  EXPECT_TRUE(notes(findings, "T(f,z): 1 samples are too few"));
  EXPECT_TRUE(notes(findings, "spectra of bottom: 1 samples are too few"));
  EXPECT_TRUE(notes(findings, "modes of bottom: 1 samples"));
}

/// Sensors on a bottom of one cell that sinks by 1 mm when loaded, and by 0.1 mm for good in every cycle.
void write_cycles(const std::string& path, int n_cycles) {
  constexpr int samples = 50;  // of a cycle
  proto::Attributes attributes = {{"sole.kind", std::string("bottom")}, {"cells.kind", std::string("pressure")}};
  for (const char* name : {"sole", "cells"}) {
    for (const char* side : {".x_min_m", ".y_min_m", ".z_m"}) attributes.emplace_back(std::string(name) + side, 0.0);
    for (const char* side : {".x_max_m", ".y_max_m", ".cell_length_m", ".cell_width_m"}) {
      attributes.emplace_back(std::string(name) + side, 1.0);
    }
  }
  auto file = proto::TimeSeriesFile::create(path,
                                            {{"time", "s", "", {}},
                                             {"sole/displacement", "m", "", {1, 1, 3}},
                                             {"sole/velocity", "m/s", "", {1, 1, 3}},
                                             {"cells/force", "N", "", {}},
                                             {"cells/pressure", "Pa", "", {1, 1}}},
                                            attributes);
  for (int i = 0; i <= n_cycles * samples; ++i) {
    const double cycles = static_cast<double>(i) / samples, load = 0.5 - 0.5 * std::cos(2 * M_PI * cycles);
    const std::vector<double> place = {0, 0, -1e-3 * load - 1e-4 * cycles}, still = {0, 0, 0};
    file.put("time", 1e-2 * i), file.put("sole/displacement", place), file.put("sole/velocity", still);
    file.put("cells/force", 1e4 * load), file.put("cells/pressure", std::vector<double>{1e4 * load});
    file.end_row();
  }
  file.close();
}

TEST(Settlement, GoesFromCycleToCycle) {
  const tests::TemporaryFolder folder;
  write_cycles(folder.file("sensors.h5"), 8);
  const auto findings = analyse(folder.path(), {});
  EXPECT_EQ(column(findings, "settlement", "cycle").size(), 8u);
  EXPECT_TRUE(near_rel(column(findings, "settlement", "unloaded")[2], 3e-4, 1e-9));
  EXPECT_TRUE(near_rel(column(findings, "settlement", "loaded")[2], 1e-3 + 2.5e-4, 1e-9));
  const std::string group = "settlement under repeated load";
  EXPECT_TRUE(near_rel(figure(findings, group, "mean of a cycle in the second half"), 1e-4, 1e-9));
  EXPECT_TRUE(near_rel(figure(findings, group, "from the first cycle to the last"), 7e-4, 1e-9));
  EXPECT_TRUE(near_rel(figure(findings, group, "unloading stiffness"), 1e4 / (1e-3 - 5e-5), 1e-9));
  write_cycles(folder.file("sensors.h5"), 1);  // one blow is no repeated load
  for (const auto& table : analyse(folder.path(), {}).tables) EXPECT_NE(table.name, "settlement");
}

TEST(EnergiesByName, SharesOfWhatDissipated) {
  const tests::TemporaryFolder folder;
  proto::FieldSeriesOptions options;
  options.mesh =
      proto::OutputMesh::of_one_type({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2, 3}, proto::CellType::tetrahedron);
  options.static_fields = {{{"body", "1", "", proto::Location::cell, 1}, {0.f}},
                           {{"sleeper", "1", "", proto::Location::cell, 1}, {0.f}}};
  options.histories = {{"time", "s", "", {}},
                       {"kinetic_energy", "J", "", {}},
                       {"friction_dissipation", "J", "", {}},
                       {"viscous_dissipation", "J", "", {}},
                       {"touching", "1", "", {}}};
  auto file = proto::FieldSeriesFile::create(folder.file("qdem.h5"), options);
  for (const double t : {0.0, 1.0, 2.0}) {
    file.put_history("time", t), file.put_history("kinetic_energy", 5 - t), file.put_history("touching", 7);
    file.put_history("friction_dissipation", 1 + 3 * t), file.put_history("viscous_dissipation", t);
    file.end_history_row();
  }
  file.close();
  const auto findings = analyse(folder.path(), {});
  EXPECT_DOUBLE_EQ(figure(findings, "energies", "kinetic_energy"), -2.0);
  EXPECT_DOUBLE_EQ(figure(findings, "share of the dissipation", "friction"), 0.75);
  EXPECT_DOUBLE_EQ(figure(findings, "share of the dissipation", "viscous"), 0.25);
  EXPECT_EQ(table(findings, "energies").columns.size(), 4u) << "a count is no energy";
}

/// Exit code and output of the program.
std::pair<int, std::string> analyze(const std::string& arguments) {
  FILE* pipe = popen((HOUSE_BIN_DIR "/coupler analyze " + arguments + " 2>&1").c_str(), "r");
  std::string text;
  for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) text += static_cast<char>(c);
  return {WEXITSTATUS(pclose(pipe)), text};
}

TEST(AnalyzeVerb, WritesFilesThatReadBack) {
  const tests::TemporaryFolder out;
  const auto [code, text] =
      analyze(run_folder() + " --bins 2 --reach 0.1 --stone 0 0.6 -0.13 --stone 0 0.9 -0.13 --out " + out.file("a"));
  EXPECT_EQ(code, 0) << text;
  EXPECT_NE(text.find("depth bins in which low frequencies are absorbed more"), std::string::npos) << text;
  const proto::ResultReader reader(out.file("a/analysis.h5"));
  const auto frequency = reader.read("/transfer/frequency").values;
  EXPECT_EQ(reader.text("/transfer/bottom_density", "units"), "(m/s)^2/Hz");
  EXPECT_NE(reader.text("/", "case_text").find("contact_output"), std::string::npos);
  EXPECT_NE(reader.text("/", "notes").find("T(f,z)"), std::string::npos);
  EXPECT_TRUE(reader.has("/history_stone_1") && reader.has("/history_stone_10")) << text;
  const auto csv = tests::read_text(out.file("a/transfer.csv"));
  EXPECT_EQ(csv.rfind("frequency [Hz],bottom_density [(m/s)^2/Hz],bin_1 [1],", 0), 0u);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), static_cast<std::ptrdiff_t>(frequency.size()) + 1);
}

TEST(AnalyzeVerb, SaysWhatIsWrong) {
  const tests::TemporaryFolder empty, damaged;
  std::ofstream(damaged.file("sensors.h5")) << "no HDF5";
  const auto expect = [](const std::string& arguments, int code, const std::string& part) {
    const auto [found, text] = analyze(arguments);
    EXPECT_EQ(found, code) << arguments << "\n" << text;
    EXPECT_NE(text.find(part), std::string::npos) << arguments << "\n" << text;
  };
  expect("/no/such/folder", 66, "no such folder");
  expect(empty.path(), 66, "there is no coupling.h5, qdem.h5 or sensors.h5");
  expect(damaged.path(), 65, "sensors.h5");
  expect("", 64, "DIR is required");
  expect(run_folder() + " --bins 0", 64, "--bins");
  expect(run_folder() + " --axis w", 64, "--axis");
  expect(run_folder() + " --low-band 100 20", 64, "a band from 100 to 20 Hz is empty");
  expect(run_folder() + " --out /proc/nothing", 73, "cannot create");
  expect(run_folder() + " --segment 0.5", 0, "a segment of 0.5 s is longer than the record of 0.0601 s");
}

TEST(AnalysisOfACoupledRun, KnowsTheSeatsAndGoesOnWithoutTheRest) {
  const tests::TemporaryFolder folder;
  proto::RailSeat seat;
  seat.name = "seat", seat.origin.setZero(), seat.axes.setIdentity(), seat.half_lengths = {0.1, 0.1},
  seat.cells = {2, 1};
  constexpr double window = 1e-3;
  coupler::CouplingRecord record(folder.file("coupling.h5"), {seat}, window, {});
  const std::vector<double> zero(6, 0.0);
  record.add_initial({zero, zero, zero, zero});
  coupler::Audit audit({{{{-0.05, 0, 0}, {0.05, 0, 0}}, 0.14}}, window);
  for (int n = 0; n < 200; ++n) {
    const double t = window * (n + 1), force = -3e4 * std::exp(-std::pow((t - 0.1) / 0.02, 2));
    coupler::WindowRecord row;
    row.window = n, row.sub_cycles = 1;
    row.rail_displacement = row.rail_velocity = row.sleeper_displacement = row.sleeper_velocity = row.force_robin =
        row.force_used = row.impulse = zero;
    row.impulse[2] = 0.25 * force * window, row.impulse[5] = 0.75 * force * window;
    row.rail_displacement_begin = zero;
    row.rail_displacement[2] = 1e-5, row.force_used[2] = 0.5e5;  // 0.5 J a window
    row.pad_work = zero;
    record.add(row, audit.add(row), audit);
  }
  record.close();
  const auto findings = analyse(folder.path(), {});
  EXPECT_TRUE(near_rel(figure(findings, "load, rail seats", "largest"), 3e4, 1e-9));
  EXPECT_TRUE(near_rel(figure(findings, "load, rail seats", "at"), 0.1, 1e-9));
  EXPECT_TRUE(near_rel(column(findings, "history_seat_seat", "force_on_sleeper")[100], -3e4, 1e-9));
  EXPECT_TRUE(near_rel(figure(findings, "energies", "given by the rail at seat"), 100.0, 1e-9));
  for (const char* missing :
       {"T(f,z): it needs a sensor of kind \"stones\" and \"bottom\"", "attenuation with depth: it needs",
        "displacement field: it needs", "pressure under the sleeper: it needs", "force chains: they need",
        "energies: they need"}) {
    EXPECT_TRUE(notes(findings, missing)) << missing;
  }
}

}  // namespace
