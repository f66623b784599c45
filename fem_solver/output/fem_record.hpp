// fem.h5: the rail's fields every output interval, the wheel every window.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fem_solver/output/patch_record.hpp"
#include "fem_solver/rail/rail_model.hpp"
#include "fem_solver/time/wheel_track.hpp"
#include "proto/case/case_file.hpp"
#include "proto/result/field_series.hpp"
#include "proto/result/state_archive.hpp"

namespace fem {

/// Writes `directory`/fem.h5 with its ParaView sidecar: shape and fields of the rail, and /TimeSeries with time, wheel
/// position, contact force, wheel displacement and velocity. With a resolved contact also its shear forces, creepage,
/// area and share of stick, and patch.h5 (PatchRecord).
class FemRecord {
 public:
  /// `program`: who writes; `rail` and `track` must outlive it; `interval_windows`: a field step each so many windows,
  /// 0 for none. Throws proto::Error (cannot_create).
  FemRecord(const std::string& directory, const std::string& program, const proto::CaseFile& file,
            const RailModel& rail, const WheelTrack& track, double window, std::int64_t interval_windows);
  /// Goes on with the file that an earlier process made with the same arguments, from what its exchange() saved.
  FemRecord(const std::string& directory, const std::string& program, const proto::CaseFile& file,
            const RailModel& rail, const WheelTrack& track, double window, std::int64_t interval_windows,
            proto::StateArchive& saved);

  /// How far the file has come.
  void exchange(proto::StateArchive& archive);
  /// What was written is safe against a loss of power.
  void synchronise();

  /// The state at time 0 (fields only).
  void begin(const WheelTrack& track);
  /// After a window of the march. Throws proto::Error (io_error).
  void window(const WheelTrack& track);
  void close();

 private:
  void put_fields(const WheelTrack& track);
  void put_patch(const WheelTrack& track);

  std::vector<RailField> fields_;
  double window_s_;
  std::int64_t interval_windows_;
  std::uint64_t n_steps_ = 0, n_history_rows_ = 0;
  std::unique_ptr<proto::FieldSeriesFile> file_;
  std::unique_ptr<PatchRecord> patch_;  // of a resolved contact
};

/// All of `state`.
void exchange(proto::StateArchive& archive, RunState& state);

/// Whole number of windows of an output interval; 0 for 0. Throws proto::Error (config) for a broken number; `key`:
/// where the interval was given.
std::int64_t windows_per_output(double output_interval, double window, const char* key = "coupling.output_interval_s");

}  // namespace fem
