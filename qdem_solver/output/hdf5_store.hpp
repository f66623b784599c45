// Arrays and texts in a serial HDF5 file, the little that a bed file needs.
#pragma once

#include <hdf5.h>

#include <string>
#include <vector>

namespace qdem {

/// An HDF5 file open for writing or reading. Every failure throws proto::Error naming the file and the data set:
/// io_error while writing, bad_data while reading. The HDF5 error stack is not printed.
class Hdf5Store {
 public:
  static Hdf5Store create(const std::string& path);
  static Hdf5Store open(const std::string& path);
  ~Hdf5Store();
  Hdf5Store(const Hdf5Store&) = delete;
  Hdf5Store& operator=(const Hdf5Store&) = delete;

  /// One-dimensional data sets; groups in `name` are made as needed. `units` becomes an attribute when not empty.
  void put(const std::string& name, const std::vector<double>& values, const std::string& units = {});
  void put(const std::string& name, const std::vector<long long>& values);
  void put(const std::string& name, const std::vector<std::string>& lines);

  std::vector<double> reals(const std::string& name) const;
  std::vector<long long> integers(const std::string& name) const;
  std::vector<std::string> lines(const std::string& name) const;

  /// Flushes and closes; a full disk shows here. Nothing may be put after it.
  void close();

 private:
  Hdf5Store(const std::string& path, hid_t file, bool writing) : path_(path), file_(file), writing_(writing) {}
  void put_raw(const std::string& name, hid_t type, const void* values, std::size_t n, const std::string& units);
  void get_raw(const std::string& name, hid_t type, void* values) const;
  std::size_t size(const std::string& name) const;
  [[noreturn]] void fail(const std::string& name) const;

  std::string path_;
  hid_t file_ = -1;
  bool writing_ = false;
};

}  // namespace qdem
