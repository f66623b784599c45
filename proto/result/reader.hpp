// Reading result files back: for reports, the sidecar writer and tests.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace proto {

/// Values of one dataset, converted to double, row-major.
struct ResultArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};

/// A result file opened for reading. It may be somebody else's: links and datasets that lead out of the file, and sizes
/// beyond what it holds, are refused (foreign_guard.hpp), and HDF5 loads no filter from a folder. HDF5 itself is not
/// hardened against files made to break it.
/// All functions throw proto::Error: missing_input (no such file), bad_data (no HDF5 file, no such object).
class ResultReader {
 public:
  explicit ResultReader(const std::string& path);
  ResultReader(ResultReader&&) noexcept;
  ~ResultReader();

  bool has(const std::string& object) const;
  /// Rows of the history in `group` ("/" or "/TimeSeries") that are whole.
  std::uint64_t n_committed(const std::string& group = "/") const;
  /// Steps of /VTKHDF that are whole; 0 when the file has no /VTKHDF.
  std::uint64_t n_steps() const;
  /// Extents of a dataset, without reading it.
  std::vector<std::size_t> shape(const std::string& dataset) const;
  /// Whether the dataset was created to grow with the steps.
  bool is_extendable(const std::string& dataset) const;
  /// Whole dataset.
  ResultArray read(const std::string& dataset) const;
  /// Only its first `n_rows` rows: pass n_committed().
  ResultArray read_rows(const std::string& dataset, std::uint64_t n_rows) const;
  /// Rows [first, first + n): one step of a field that is too large to be read whole.
  ResultArray read_rows(const std::string& dataset, std::uint64_t first, std::uint64_t n) const;
  bool has_attribute(const std::string& object, const std::string& attribute) const;
  /// Attribute of a dataset or group; `number` also reads integers.
  double number(const std::string& object, const std::string& attribute) const;
  std::string text(const std::string& object, const std::string& attribute) const;
  /// Names of the members of a group, sorted.
  std::vector<std::string> members(const std::string& group) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace proto
