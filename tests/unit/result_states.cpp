// States in files of their own, and result files that another process goes on with.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "proto/error.hpp"
#include "proto/result/field_series.hpp"
#include "proto/result/reader.hpp"
#include "proto/result/state_file.hpp"
#include "tests/support/processes.hpp"

namespace {

using proto::StateReader;
using proto::StateWriter;

struct Body {
  double mass = 0.0;
  std::int64_t steps = 0;
  bool resting = false;
  std::string name;
  std::vector<double> positions;
  std::vector<int> nodes;
  std::vector<Eigen::Vector3d> slips;
  Eigen::VectorXd loads;

  void exchange(proto::StateArchive& archive) {
    archive("body/mass", mass);
    archive("body/steps", steps);
    archive("body/resting", resting);
    archive("body/name", name);
    archive("body/positions", positions);
    archive("body/nodes", nodes);
    archive("body/slips", slips);
    archive("body/loads", loads);
  }
};

Body sample() {
  return {0.1 + 0.2, -7, true, "st\xc3\xb6ne", {1.0 / 3.0, -0.0, INFINITY, 5e-324}, {3, -1}, {{1, 2, 3}, {4, 5, 6}},
          {}};
}

class States : public ::testing::Test {
 protected:
  std::uint64_t write(Body body) {
    StateWriter archive;
    body.exchange(archive);
    return archive.write(path);
  }
  proto::ExitCode code_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const proto::Error& error) {
      return error.code();
    }
    return proto::ExitCode::ok;
  }
  tests::TemporaryFolder folder;
  std::string path = folder.file("state.h5");
};

TEST_F(States, ComeBackToTheBit) {
  const Body before = sample();
  Body after;
  StateReader archive(path, write(before));
  after.exchange(archive);
  EXPECT_EQ(after.mass, before.mass);
  EXPECT_EQ(after.steps, before.steps);
  EXPECT_EQ(after.resting, before.resting);
  EXPECT_EQ(after.name, before.name);
  EXPECT_EQ(after.positions, before.positions);
  EXPECT_TRUE(std::signbit(after.positions[1]));
  EXPECT_EQ(after.nodes, before.nodes);
  EXPECT_EQ(after.slips, before.slips);
  EXPECT_EQ(after.loads.size(), 0);
}

TEST_F(States, HaveOneHashForEqualValues) {
  const auto hash = write(sample());
  EXPECT_EQ(write(sample()), hash);
  StateWriter archive;
  Body body = sample();
  body.exchange(archive);
  EXPECT_EQ(archive.hash(), hash);
  body.mass = std::nextafter(body.mass, 1.0);
  EXPECT_NE(write(body), hash);
}

TEST_F(States, AreRefusedWhenDamagedOrCut) {
  const auto hash = write(sample());
  const auto bytes = tests::read_text(path);
  for (std::size_t i = 0; i < bytes.size(); i += 97) {
    auto damaged = bytes;
    damaged[i] ^= 0x10;
    std::ofstream(path, std::ios::binary) << damaged;
    EXPECT_EQ(code_of([&] { StateReader(path, hash); }), proto::ExitCode::bad_data) << "byte " << i;
    std::ofstream(path, std::ios::binary) << bytes.substr(0, i);
    EXPECT_EQ(code_of([&] { StateReader(path, hash); }), proto::ExitCode::bad_data) << "cut at " << i;
  }
  EXPECT_EQ(code_of([&] { StateReader(folder.file("none"), hash); }), proto::ExitCode::missing_input);
}

TEST_F(States, AreRefusedByAnotherModel) {
  StateWriter archive;
  archive.expect_same("bed", "the bed", "one");
  std::vector<double> values(3);
  archive("values", values);
  StateReader reader(path, archive.write(path));
  EXPECT_NO_THROW(reader.expect_same("bed", "the bed", "one"));
  EXPECT_EQ(code_of([&] { reader.expect_same("bed", "the bed", "two"); }), proto::ExitCode::bad_data);
  double value = 0.0;
  EXPECT_EQ(code_of([&] { reader("values", value); }), proto::ExitCode::bad_data);
  EXPECT_EQ(code_of([&] { reader("none", value); }), proto::ExitCode::bad_data);
}

proto::FieldSeriesOptions field_options() {
  proto::FieldSeriesOptions options;
  options.mesh = proto::OutputMesh::of_one_type({0, 0, 0, 1, 0, 0}, {0, 1}, proto::CellType::line);
  options.fields = {{"temperature", "K", "of the ends", proto::Location::point, 1}};
  options.histories = {{"energy", "J", "of all", {}}};
  return options;
}

void add_steps(proto::FieldSeriesFile& file, int first, int n, float offset) {
  for (int i = first; i < first + n; ++i) {
    for (int row = 0; row < 2; ++row) {
      file.put_history("energy", 10.0 * i + row + static_cast<double>(offset));
      file.end_history_row();
    }
    file.begin_step(0.1 * i);
    const std::vector<float> values{static_cast<float>(i) + offset, offset};
    file.put("temperature", proto::Span<const float>(values.data(), values.size()));
    file.end_step();
  }
}

TEST_F(States, ResultFilesGoOnAfterAGivenStep) {
  {
    auto file = proto::FieldSeriesFile::create(path, field_options());
    add_steps(file, 0, 9, 0.25f);  // ends without a close, as by a kill
  }
  auto file = proto::FieldSeriesFile::resume(path, 4, 8, field_options());
  EXPECT_EQ(file.n_steps(), 4u);
  EXPECT_EQ(file.n_history_rows(), 8u);
  add_steps(file, 4, 2, 0.5f);
  file.close();
  const proto::ResultReader reader(path);
  EXPECT_EQ(reader.n_steps(), 6u);
  const auto energy = reader.read_rows("/TimeSeries/energy", reader.n_committed("/TimeSeries")).values;
  EXPECT_EQ(energy,
            (std::vector<double>{0.25, 1.25, 10.25, 11.25, 20.25, 21.25, 30.25, 31.25, 40.5, 41.5, 50.5, 51.5}));
  const auto temperature = reader.read("/VTKHDF/PointData/temperature").values;
  EXPECT_EQ(temperature, (std::vector<double>{0.25, 0.25, 1.25, 0.25, 2.25, 0.25, 3.25, 0.25, 4.5, 0.5, 5.5, 0.5}));
  EXPECT_FALSE(std::filesystem::exists(path + ".resumed"));
}

TEST_F(States, AResultFileThatIsNotSoLongIsRefusedAndKept) {
  {
    auto file = proto::FieldSeriesFile::create(path, field_options());
    add_steps(file, 0, 3, 0.0f);
  }
  EXPECT_EQ(code_of([&] { proto::FieldSeriesFile::resume(path, 4, 8, field_options()); }), proto::ExitCode::bad_data);
  EXPECT_EQ(proto::ResultReader(path).n_steps(), 3u);
}

}  // namespace
