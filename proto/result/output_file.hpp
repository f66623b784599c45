// An HDF5 file that is created whole, then only appended to, and left alone after its first failure. Internal.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "proto/error.hpp"
#include "proto/result/attributes.hpp"
#include "proto/result/hdf5_handle.hpp"

namespace proto::hdf5 {

/// How a dataset is laid out: extendable rows of a fixed shape.
struct DatasetSpec {
  std::string name;                ///< path from the root; missing groups are created
  hid_t type = -1;                 ///< of the file
  std::vector<hsize_t> row_shape;  ///< empty: scalar rows
  hsize_t chunk_rows = 1;
  std::string unit, description;  ///< attributes `units`, `description`; none if empty
};

/// One file being written. Not copyable; identifiers of everything opened during the run belong to it.
class OutputFile {
 public:
  /// Creates the file with its root attributes. Throws proto::Error (cannot_create).
  OutputFile(const std::string& path, const Attributes& attributes);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  const std::string& path() const { return path_; }
  hid_t id() const { return file_.id(); }

  /// Set-up calls, before seal().
  hid_t create_group(const std::string& name);
  hid_t create_dataset(const DatasetSpec& spec);
  /// A dataset that never changes, of `dims`, written at once.
  void write_static(const std::string& name, hid_t file_type, hid_t memory_type, const std::vector<hsize_t>& dims,
                    const void* values, const std::string& unit = {}, const std::string& description = {});
  void write_attribute(hid_t object, const std::string& name, const Attribute& value);
  /// An int64 attribute that is rewritten in place later: a commit counter, starting at 0.
  hid_t create_counter(hid_t object, const std::string& name);
  /// Ends the set-up: flushes; later failures are io_error.
  void seal();

  /// Runs `action`, the writing of about `bytes`, unless an earlier one failed. After a throw from it nothing is
  /// written to this file any more. Disk blocks are reserved first, because HDF5 cannot recover from a full disk.
  template <class Action>
  void write(std::uint64_t bytes, Action&& action) {
    refuse_if_broken();
    broken_ = true;
    reserve(bytes);
    action();
    broken_ = false;
  }

  /// Used inside write(): appends `n_rows` rows after row `first_row`.
  void append_rows(hid_t dataset, hid_t memory_type, const std::vector<hsize_t>& row_shape, hsize_t first_row,
                   hsize_t n_rows, const void* values);
  void set_counter(hid_t counter, std::int64_t value);
  void flush();

  /// Gives the file another name, in place of whatever has it. Throws (io_error).
  void rename_to(const std::string& path);
  /// After a flush: content safe against a loss of power. Throws (io_error).
  void synchronise() const;

  /// Closes everything; throws (io_error) if HDF5 reports a failure.
  void close();

  /// Throws the error of this file's state with HDF5's reason if `status` is negative; else returns it.
  template <class Status>
  Status check(Status status, const char* action) const {
    if (status < 0) fail(action, last_error());
    return status;
  }

 private:
  [[noreturn]] void fail(const std::string& action, const std::string& reason) const;
  void refuse_if_broken() const;
  /// Throws (io_error) when the disk has no room for `bytes` more.
  void reserve(std::uint64_t bytes);
  void give_back_blocks() const;
  /// Makes the file as long as it will be and writes that length where a reader looks for it, before anything refers to
  /// what lies there.
  void announce_end();
  int descriptor() const;
  hid_t keep(Handle handle, const char* action);

  std::string path_;
  ExitCode code_ = ExitCode::cannot_create;
  bool broken_ = false;
  std::uint64_t reserved_end_ = 0;  // of the blocks that the disk has set aside
  Handle file_;
  std::vector<Handle> kept_;
};

}  // namespace proto::hdf5
