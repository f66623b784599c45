// patch.h5: the fields of a resolved contact at a rate of their own.
#pragma once

#include <memory>
#include <string>

#include "fem_solver/time/wheel_track.hpp"
#include "proto/case/case_file.hpp"
#include "proto/result/state_archive.hpp"
#include "proto/result/time_series.hpp"

namespace fem {

/// Writes `directory`/patch.h5: time, position, and per element [n_y][n_x] pressure, shear on the wheel, slip per
/// distance rolled (with the zone: open, stick, slip), about the centre of a grid that travels with the wheel.
class PatchRecord {
 public:
  /// `window`: length [s]. Rows every `record_interval_s` of the case; nothing where that is 0. `saved`: nullptr, or
  /// what an earlier process saved, to go on with its file. Throws proto::Error: cannot_create; config for an interval
  /// that is not a whole number of windows.
  PatchRecord(const std::string& directory, const std::string& program, const proto::CaseFile& file,
              const PatchContact& contact, double window, proto::StateArchive* saved);

  void exchange(proto::StateArchive& archive) { archive("record/patch_rows", n_rows_); }
  void synchronise();
  /// After a window. Throws proto::Error (io_error).
  void window(const RunState& state);
  void close();

 private:
  const PatchContact& contact_;
  double window_s_;
  std::int64_t interval_windows_;
  std::uint64_t n_rows_ = 0;
  std::unique_ptr<proto::TimeSeriesFile> file_;  // none: nothing is recorded
};

}  // namespace fem
