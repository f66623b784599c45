// A state in a file of its own, from which a run can go on: written whole or not at all, read only if unharmed.
//
// HDF5 (every dataset with a fletcher32 checksum), float64 and int64 datasets only, under the names that
// the state gave. The same values make the same bytes.
#pragma once

#include <memory>
#include <string>

#include "proto/result/state_archive.hpp"

namespace proto {

/// Gathers a state in memory, then writes it.
class StateWriter : public StateArchive {
 public:
  StateWriter();
  ~StateWriter() override;
  using StateArchive::operator();
  bool restoring() const override { return false; }
  void operator()(const std::string& name, std::vector<double>& values) override;
  void operator()(const std::string& name, std::vector<std::int64_t>& values) override;

  /// Writes `path` by way of a temporary file, both it and its folder synchronised with the disk. Once only.
  /// Returns the XXH3-64 of the file's bytes. Throws proto::Error (cannot_create, io_error); then `path` is as before.
  std::uint64_t write(const std::string& path);

  /// The same hash without a file.
  std::uint64_t hash();

 private:
  [[noreturn]] void refuse(const std::string& name, const std::string& problem) const override;
  std::string image();
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Reads what StateWriter wrote.
class StateReader : public StateArchive {
 public:
  /// Throws proto::Error: missing_input (no such file), bad_data when its bytes do not have this hash.
  StateReader(const std::string& path, std::uint64_t hash);
  ~StateReader() override;
  using StateArchive::operator();
  bool restoring() const override { return true; }
  void operator()(const std::string& name, std::vector<double>& values) override;
  void operator()(const std::string& name, std::vector<std::int64_t>& values) override;

 private:
  [[noreturn]] void refuse(const std::string& name, const std::string& problem) const override;
  struct Data;
  std::unique_ptr<Data> data_;
};

/// XXH3-64 of a file's bytes. Throws proto::Error (missing_input, io_error).
std::uint64_t hash_of_file(const std::string& path);

}  // namespace proto
