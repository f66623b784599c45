// Small text files that are either whole or not there.
#pragma once

#include <string>

namespace proto {

/// Writes `text` to a temporary file in the same folder, syncs it, renames it to `path`, syncs the folder.
/// Throws proto::Error: cannot_create or io_error with path and reason; an older file under `path` then stays as it
/// was.
void write_text_file(const std::string& path, const std::string& text);

/// The same without waiting for the disk: whole for every reader, but may be lost with the machine's power.
void replace_text_file(const std::string& path, const std::string& text);

}  // namespace proto
