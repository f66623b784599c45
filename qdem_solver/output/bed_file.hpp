// The file of a finished bed: templates, bodies, state, contact history, report. HDF5, serial.
#pragma once

#include <string>

#include "qdem_solver/bed/bed.hpp"

namespace qdem {

/// Version of the layout and of the building procedure; part of the inputs' hash, so that old files are built anew.
inline constexpr int bed_file_format = 8;

/// Writes `bed` to `path`: first beside it under a name of its own, then renamed, so that a reader never sees half a
/// file. Materials, contact law, bearings and gravity are inputs and are not stored. Throws proto::Error:
/// cannot_create, io_error.
void write_bed_file(const std::string& path, const Bed& bed);

/// The bed of `path`, bitwise as it was written; materials, contact law, bearings and gravity from `physics`. Throws
/// proto::Error: missing_input, or bad_data when the file is not a whole bed file of this format.
Bed read_bed_file(const std::string& path, const BedPhysics& physics);

}  // namespace qdem
