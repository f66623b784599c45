// What goes into a result file comes out of it: values, shapes, units, counters; and nothing else does.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

#include "proto/error.hpp"
#include "proto/result/array_file.hpp"
#include "proto/result/provenance.hpp"
#include "proto/result/reader.hpp"
#include "proto/result/text_file.hpp"
#include "proto/result/xdmf.hpp"
#include "tests/support/result_samples.hpp"

namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

template <class Action>
proto::ExitCode code_of(Action&& action) {
  try {
    action();
  } catch (const proto::Error& error) {
    return error.code();
  }
  return proto::ExitCode::ok;
}

TEST(TimeSeriesFile, ReturnsRowsUnitsAndAttributes) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("coupling.h5");
  const auto attributes = proto::provenance("coupler", "quick", 0xabcu, "[coupling]\n");
  auto file = proto::TimeSeriesFile::create(path, tests::sample_columns(), attributes, 10);
  for (std::size_t row = 0; row < 25; ++row) tests::write_sample_row(file, row);
  EXPECT_EQ(file.n_rows(), 25u);
  EXPECT_EQ(file.n_committed(), 20u);
  file.close();

  const proto::ResultReader reader(path);
  ASSERT_EQ(reader.n_committed(), 25u);
  const auto impulse = reader.read_rows("/seats/seat/impulse", 25);
  EXPECT_EQ(impulse.shape, (std::vector<std::size_t>{25, 9, 3}));
  for (std::size_t row = 0; row < 25; ++row) {
    const auto expected = tests::sample_row(row);
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), impulse.values.begin() + 27 * row)) << "row " << row;
  }
  EXPECT_EQ(reader.text("/seats/seat/impulse", "units"), "N s");
  EXPECT_EQ(reader.text("/seats/seat/impulse", "description"), "on the sleeper");
  EXPECT_EQ(reader.text("/", "case_hash"), "0000000000000abc");
  EXPECT_EQ(reader.text("/", "case_text"), "[coupling]\n");
  EXPECT_EQ(reader.text("/", "version"), proto::project_version());
}

TEST(TimeSeriesFile, KeepsLongHistoriesOverManyChunks) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("long.h5");
  auto file = proto::TimeSeriesFile::create(path, tests::sample_columns(), {}, 7);
  for (std::size_t row = 0; row < 3000; ++row) tests::write_sample_row(file, row);
  file.close();
  const auto values = proto::ResultReader(path).read("/seats/seat/impulse").values;
  ASSERT_EQ(values.size(), 3000u * 27u);
  for (std::size_t row = 0; row < 3000; ++row) ASSERT_EQ(values[27 * row + 4], tests::sample_row(row)[4]) << row;
}

TEST(TimeSeriesFile, RefusesMisuseByName) {
  const tests::TemporaryFolder folder;
  auto file = proto::TimeSeriesFile::create(folder.file("a.h5"), tests::sample_columns());
  EXPECT_EQ(code_of([&] { file.put("tiem", 1.0); }), proto::ExitCode::internal);
  EXPECT_EQ(code_of([&] { file.put("time", std::vector<double>{1, 2}); }), proto::ExitCode::internal);
  file.put("time", 1.0);
  EXPECT_EQ(code_of([&] { file.end_row(); }), proto::ExitCode::internal);
  tests::write_sample_row(file, 3);  // the object survives
  file.close();
  EXPECT_EQ(proto::ResultReader(folder.file("a.h5")).read("/time").values, std::vector<double>{5e-5 * 3});
}

TEST(TimeSeriesFile, RowsNotCommittedAreNotCounted) {
  const tests::TemporaryFolder folder;
  {
    auto file = proto::TimeSeriesFile::create(folder.file("a.h5"), tests::sample_columns(), {}, 10);
    for (std::size_t row = 0; row < 13; ++row) tests::write_sample_row(file, row);
  }
  EXPECT_EQ(proto::ResultReader(folder.file("a.h5")).n_committed(), 10u);
}

TEST(FieldSeriesFile, ReturnsMeshFieldsAndSteps) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("qdem.h5");
  auto file = proto::FieldSeriesFile::create(path, tests::sample_fields(5));
  for (std::size_t step = 0; step < 3; ++step) tests::write_sample_step(file, step, 5);
  EXPECT_EQ(file.n_steps(), 3u);
  file.close();

  const proto::ResultReader reader(path);
  EXPECT_EQ(reader.n_steps(), 3u);
  EXPECT_EQ(reader.n_committed("/TimeSeries"), 3u);
  EXPECT_EQ(reader.read("/TimeSeries/kinetic_energy").values, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(reader.read("/VTKHDF/Steps/Values").values, (std::vector<double>{0, 1e-3, 2e-3}));
  EXPECT_EQ(reader.shape("/VTKHDF/Points"), (std::vector<std::size_t>{20, 3}));
  EXPECT_EQ(reader.shape("/VTKHDF/PointData/displacement"), (std::vector<std::size_t>{60, 3}));
  EXPECT_EQ(reader.read("/VTKHDF/Steps/PointDataOffsets/displacement").values, (std::vector<double>{0, 20, 40}));
  EXPECT_EQ(reader.read("/VTKHDF/Steps/CellDataOffsets/stone").values, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(reader.read("/VTKHDF/NumberOfCells").values, (std::vector<double>{5, 5, 5}));
  EXPECT_EQ(reader.read("/VTKHDF/Offsets").values, (std::vector<double>{0, 4, 8, 12, 16, 20}));
  EXPECT_EQ(reader.text("/VTKHDF/CellData/stress", "units"), "Pa");
  const auto stress = reader.read("/VTKHDF/CellData/stress").values;
  EXPECT_EQ(stress[5 * 2 + 3], tests::sample_value(2, 3));
}

TEST(FieldSeriesFile, SidecarShowsEveryStepThroughViews) {
  const tests::TemporaryFolder folder;
  auto file = proto::FieldSeriesFile::create(folder.file("qdem.h5"), tests::sample_fields(5));
  for (std::size_t step = 0; step < 3; ++step) tests::write_sample_step(file, step, 5);
  file.close();
  std::filesystem::rename(folder.path(), folder.path().string() + "_moved");  // only relative names inside
  const std::filesystem::path moved = folder.path().string() + "_moved";
  const proto::ResultReader views((moved / "qdem.views.h5").string());
  for (std::size_t step = 0; step < 3; ++step) {
    const auto view = views.read("/step_" + std::to_string(step) + "/points/displacement");
    EXPECT_EQ(view.shape, (std::vector<std::size_t>{20, 3}));
    EXPECT_EQ(view.values[7], tests::sample_value(step, 7));
  }
  const auto topology = views.read("/Topology");
  EXPECT_EQ(topology.shape, (std::vector<std::size_t>{5, 4}));
  EXPECT_EQ(topology.values[13], 13.0);
  const std::string text = bytes_of((moved / "qdem.xdmf").string());
  EXPECT_EQ(text.find(folder.path().string()), std::string::npos);
  EXPECT_NE(text.find("<Time Value=\"0.002\"/>"), std::string::npos);
  EXPECT_EQ(text.find("HyperSlab"), std::string::npos);  // ParaView 5.11 aborts on them
  std::filesystem::rename(moved, folder.path());
}

TEST(FieldSeriesFile, MeshOfSeveralCellTypesHasItsOwnTopology) {
  const tests::TemporaryFolder folder;
  proto::FieldSeriesOptions options;
  options.mesh = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 0, 1, 2}, {proto::CellType::line, proto::CellType::triangle}};
  auto file = proto::FieldSeriesFile::create(folder.file("m.h5"), options);
  file.begin_step(0.0);
  file.end_step();
  file.close();
  EXPECT_EQ(proto::ResultReader(folder.file("m.views.h5")).read("/Topology").values,
            (std::vector<double>{2, 2, 0, 1, 4, 0, 1, 2}));
}

TEST(FieldSeriesFile, RefusesMisuseByName) {
  const tests::TemporaryFolder folder;
  auto bad = tests::sample_fields(2);
  bad.mesh.connectivity[3] = 8;
  EXPECT_EQ(code_of([&] { proto::FieldSeriesFile::create(folder.file("b.h5"), bad); }), proto::ExitCode::internal);
  auto file = proto::FieldSeriesFile::create(folder.file("a.h5"), tests::sample_fields(2));
  EXPECT_EQ(code_of([&] { file.end_step(); }), proto::ExitCode::internal);
  file.begin_step(0.0);
  EXPECT_EQ(code_of([&] { file.put("displacment", std::vector<float>(24)); }), proto::ExitCode::internal);
  EXPECT_EQ(code_of([&] { file.put("stress", std::vector<float>(24)); }), proto::ExitCode::internal);
  EXPECT_EQ(code_of([&] { file.end_step(); }), proto::ExitCode::internal);
}

TEST(ResultFiles, EqualRunsGiveEqualBytes) {
  const tests::TemporaryFolder folder;
  const auto write = [&](const std::string& name) {
    auto file = proto::FieldSeriesFile::create(folder.file(name), tests::sample_fields(5));
    for (std::size_t step = 0; step < 3; ++step) tests::write_sample_step(file, step, 5);
    file.close();
    return bytes_of(folder.file(name));
  };
  const std::string first = write("one.h5");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 would store times in whole seconds
  EXPECT_TRUE(first == write("two.h5"));
}

TEST(ResultFiles, ErrorsNameThePath) {
  const tests::TemporaryFolder folder;
  const std::string nowhere = folder.file("missing/coupling.h5");
  try {
    proto::TimeSeriesFile::create(nowhere, tests::sample_columns());
    FAIL() << "a file in a folder that is not there";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::cannot_create);
    EXPECT_NE(std::string(error.what()).find(nowhere), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("No such file or directory"), std::string::npos) << error.what();
  }
  EXPECT_EQ(code_of([&] { proto::ResultReader(folder.file("none.h5")); }), proto::ExitCode::missing_input);
  std::ofstream(folder.file("text.h5")) << "not a result";
  EXPECT_EQ(code_of([&] { proto::ResultReader(folder.file("text.h5")); }), proto::ExitCode::bad_data);
  EXPECT_EQ(code_of([&] { proto::write_xdmf(folder.file("text.h5")); }), proto::ExitCode::bad_data);
}

TEST(TextFile, IsWholeOrAsBefore) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("summary.json");
  proto::write_text_file(path, "{}\n");
  proto::write_text_file(path, "{\"status\": \"complete\"}\n");
  EXPECT_EQ(bytes_of(path), "{\"status\": \"complete\"}\n");
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
  EXPECT_EQ(code_of([&] { proto::write_text_file(folder.file("no/summary.json"), "x"); }),
            proto::ExitCode::cannot_create);
}

TEST(ArrayFile, HoldsArraysWithTheirUnits) {
  const tests::TemporaryFolder folder;
  const std::string path = folder.file("arrays.h5");
  proto::write_array_file(path, {{"a/x", "m", "place", {1, 2, 3, 4}}, {"a/none", "1", "", {}}},
                          {{"who", std::string("me")}});
  const proto::ResultReader reader(path);
  EXPECT_EQ(reader.read("/a/x").values, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(reader.read_rows("/a/x", 1, 2).values, (std::vector<double>{2, 3}));
  EXPECT_THROW(reader.read_rows("/a/x", 3, 2), proto::Error);
  EXPECT_EQ(reader.text("/a/x", "units"), "m");
  EXPECT_EQ(reader.text("/a/x", "description"), "place");
  EXPECT_TRUE(reader.read("/a/none").values.empty());
  EXPECT_TRUE(reader.has_attribute("/", "who"));
  EXPECT_FALSE(reader.has_attribute("/", "whom"));
  EXPECT_THROW(proto::write_array_file(folder.file("no/such/folder.h5"), {}, {}), proto::Error);
}

}  // namespace
