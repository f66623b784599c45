// fem.h5: the rail's fields every output interval, the wheel every window.
#pragma once

#include <memory>
#include <string>

#include "fem_solver/assembly/rail_system.hpp"
#include "fem_solver/time/wheel_track.hpp"
#include "proto/case/case_file.hpp"
#include "proto/result/field_series.hpp"

namespace fem {

/// Writes `directory`/fem.h5 with its ParaView sidecar: hexahedra between the elements' corner nodes with displacement,
/// velocity and von Mises stress, and /TimeSeries with time, wheel position, contact force, wheel displacement and
/// velocity.
class FemRecord {
 public:
  /// `interval_windows`: a field step each so many windows, 0 for none. Throws proto::Error (cannot_create).
  FemRecord(const std::string& directory, const proto::CaseFile& file, const RailSystem& system,
            const Material& material, double window, std::int64_t interval_windows);

  /// The state at time 0 (fields only).
  void begin(const WheelTrack& track);
  /// After a window of the march. Throws proto::Error (io_error).
  void window(const WheelTrack& track);
  void close();

 private:
  void fields(const WheelTrack& track);

  const RailSystem& system_;
  Material material_;
  double window_s_;
  std::int64_t interval_windows_;
  std::vector<int> corner_nodes_;  // node of the mesh for each point of the file
  std::unique_ptr<proto::FieldSeriesFile> file_;
};

/// Whole number of windows of an output interval; 0 for 0. Throws proto::Error (config) for a broken number.
std::int64_t windows_per_output(double output_interval, double window);

}  // namespace fem
