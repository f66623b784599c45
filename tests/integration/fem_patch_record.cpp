// A wheel on a resolved patch through the record: histories in fem.h5, fields in patch.h5, a restart to the bit.
#include <gtest/gtest.h>

#include <cmath>

#include "fem_solver/beam/beam_rail.hpp"
#include "fem_solver/participant/fem_participant.hpp"
#include "proto/result/reader.hpp"
#include "proto/result/state_file.hpp"
#include "tests/support/case_changes.hpp"
#include "tests/support/processes.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using tests::near_rel;

/// The quick case with a patch that is recorded every two windows.
fem::FemCase patch_case(const tests::TemporaryFolder& folder) {
  const std::string text =
      tests::with_changes(tests::read_text(HOUSE_SOURCE_DIR "/cases/wheel_passage_quick/case.toml"),
                          {{"rail_crown_radius_m",
                            "0.3\ncontact = \"patch\"\n[wheel.patch]\nfriction = 0.3\n"
                            "longitudinal_creepage = -2e-3\nrecord_interval_s = 1e-4\n"}});
  const std::string path = folder.path() + "/case.toml";
  std::ofstream(path) << text;
  return fem::read_fem_case(path);
}

/// Rail and wheel of a process that runs the case alone.
struct Passage {
  explicit Passage(const fem::FemCase& input)
      : rail(fem::build_beam_rail(input.fem, input.seats, fem::SeatOwner::own_supports)),
        track(*rail, input.fem, input.wheel, input.coupling.window_s, {}) {}

  void march(fem::FemRecord& record, int n) {
    for (int k = 0; k < n; ++k) track.march({}), record.window(track);
  }

  std::unique_ptr<fem::RailModel> rail;
  fem::WheelTrack track;
};

TEST(PatchRecord, holds_what_the_patch_carries) {
  const tests::TemporaryFolder folder;
  const auto input = patch_case(folder);
  Passage run(input);
  fem::FemRecord record(folder.path(), "test", input.file, *run.rail, run.track, 5e-5, 0);
  run.march(record, 6);
  record.close();
  const proto::ResultReader fem_file(folder.path() + "/fem.h5"), patch_file(folder.path() + "/patch.h5");
  ASSERT_EQ(fem_file.n_committed("/TimeSeries"), 6u);
  ASSERT_EQ(patch_file.n_committed(), 3u);
  const auto shear = patch_file.read("shear_x"), pressure = patch_file.read("pressure"), zone = patch_file.read("zone");
  const auto x = patch_file.read_rows("element_x", 1).values, y = patch_file.read_rows("element_y", 1).values;
  ASSERT_EQ(pressure.shape, (std::vector<std::size_t>{3, y.size(), x.size()}));
  const double area = (x[1] - x[0]) * (y[1] - y[0]);
  const std::size_t n = x.size() * y.size();
  const auto forces = fem_file.read("TimeSeries/wheel/longitudinal_force").values;
  const auto normal = fem_file.read("TimeSeries/wheel/contact_force").values;
  for (std::size_t row = 0; row < 3; ++row) {
    double pull = 0.0, push = 0.0;
    for (std::size_t k = row * n; k < (row + 1) * n; ++k) {
      pull += shear.values[k] * area, push += pressure.values[k] * area;
      EXPECT_EQ(zone.values[k] > 0, pressure.values[k] > 0);
    }
    EXPECT_TRUE(near_rel(pull, forces[2 * row + 1], 1e-9));
    EXPECT_TRUE(near_rel(push, normal[2 * row + 1], 1e-6));
    EXPECT_GT(pull, 0.0);
  }
  EXPECT_GT(forces[5], forces[1]);  // from no traction towards steady rolling
}

TEST(PatchRecord, goes_on_after_a_restart_with_the_same_bits) {
  const tests::TemporaryFolder whole, broken;
  const auto input = patch_case(whole);
  {
    Passage run(input);
    fem::FemRecord record(whole.path(), "test", input.file, *run.rail, run.track, 5e-5, 0);
    run.march(record, 12);
    record.close();
  }
  const std::string saved = broken.path() + "/state";
  std::uint64_t hash = 0;
  {
    Passage run(input);
    fem::FemRecord record(broken.path(), "test", input.file, *run.rail, run.track, 5e-5, 0);
    run.march(record, 6);
    proto::StateWriter archive;
    fem::RunState state = run.track.state();
    fem::exchange(archive, state);
    record.synchronise();
    record.exchange(archive);
    hash = archive.write(saved);
    run.march(record, 3);  // lost
    record.close();
  }
  Passage run(input);
  proto::StateReader archive(saved, hash);
  fem::RunState state = run.track.state();
  fem::exchange(archive, state);
  run.track.set_state(state);
  fem::FemRecord record(broken.path(), "test", input.file, *run.rail, run.track, 5e-5, 0, archive);
  run.march(record, 6);
  record.close();
  const auto expect_equal = [&](const std::string& name, const std::string& group) {
    const proto::ResultReader one(whole.path() + name), other(broken.path() + name);
    ASSERT_EQ(one.n_committed(group), other.n_committed(group));
    for (const auto& column : one.members(group))
      if (column != "wheel") {
        EXPECT_TRUE(one.read(group + "/" + column).values == other.read(group + "/" + column).values) << column;
      }
  };
  expect_equal("/patch.h5", "/");
  expect_equal("/fem.h5", "/TimeSeries");
  const proto::ResultReader one(whole.path() + "/fem.h5"), other(broken.path() + "/fem.h5");
  for (const auto& column : one.members("TimeSeries/wheel"))
    EXPECT_TRUE(one.read("TimeSeries/wheel/" + column).values == other.read("TimeSeries/wheel/" + column).values)
        << column;
}

}  // namespace
