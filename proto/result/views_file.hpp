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

/// The cells as a sidecar lists them: a table of nodes over the file's connectivity, or numbers of its own.
struct ViewedTopology {
  std::uint64_t n_cells = 0, n_nodes = 0;  ///< of a mesh of one cell type; a view of /VTKHDF/Connectivity
  std::vector<std::int64_t> mixed;         ///< of a mesh of several: cell codes and nodes, stored
};

/// Writes `path` whole: views of `source` (a file name relative to the folder of `path`) for `n_steps` steps, and the
/// dataset /Topology. Throws proto::Error (cannot_create, io_error).
void write_views(const std::string& path, const std::string& source, const std::vector<ViewedField>& fields,
                 std::uint64_t n_steps, const ViewedTopology& topology);

}  // namespace proto::hdf5
