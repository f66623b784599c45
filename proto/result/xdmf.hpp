// The sidecar by which ParaView 5.11 and meshio open a result file: NAME.xdmf and NAME.views.h5 beside NAME.h5.
#pragma once

#include <string>

namespace proto {

/// Writes NAME.views.h5 (virtual datasets, one per step and field; no copy of the values) and NAME.xdmf for the
/// committed steps of NAME.h5, a file of FieldSeriesFile. Can be repeated at any time, also after its writer was
/// killed; NAME.h5 itself is only read. Both files are written under another name and renamed, and hold relative names
/// only. Returns the path of the .xdmf. Throws proto::Error: missing_input, bad_data (not such a file), cannot_create,
/// io_error.
std::string write_xdmf(const std::string& path);

}  // namespace proto
