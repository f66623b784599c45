// NAME.views.h5: one virtual dataset per step and field over NAME.h5. Internal.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace proto::hdf5 {

/// Field of a result file as the sidecar needs it.
struct ViewedField {
  std::string name;
  bool of_points = true;
  bool is_static = false;    ///< one value for all steps: needs no view
  std::uint64_t n_rows = 0;  ///< per step
  std::uint64_t n_components = 1;
  std::uint64_t n_stored = 0;  ///< rows of the dataset in the file
  /// Path in the result file.
  std::string dataset() const { return std::string("/VTKHDF/") + (of_points ? "PointData/" : "CellData/") + name; }
};

/// Name of the view of one field and step inside the views file.
std::string view_name(const ViewedField& field, std::uint64_t step);

/// Writes `path` whole: views of `source` (a file name relative to the folder of `path`) for `n_steps` steps, and, if
/// not empty, the dataset /Topology. Throws proto::Error (cannot_create, io_error).
void write_views(const std::string& path, const std::string& source, const std::vector<ViewedField>& fields,
                 std::uint64_t n_steps, const std::vector<std::int64_t>& topology);

}  // namespace proto::hdf5
