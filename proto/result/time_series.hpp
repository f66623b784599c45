// Histories: one row per time window, columns of fixed shape, safe against the death of the writer.
//
// Layout in HDF5: one dataset [rows][shape...] of float64 per column, attributes `units` and `description` on it, and
// on the group that holds the columns the attribute `n_committed`: rows below it are whole, rows above it (if any) are
// not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proto/result/attributes.hpp"
#include "proto/span.hpp"

namespace proto {

/// One column of a history. `name` may contain groups: "seats/seat/impulse".
struct Column {
  std::string name;
  std::string unit;  ///< "N s", "m", "1" for a pure number
  std::string description;
  std::vector<std::size_t> shape;  ///< of one row's value; empty: a scalar
};

/// An HDF5 file that holds one history in its root. Everything is created by create(); afterwards rows are appended
/// only.
///
/// A commit writes the rows, flushes, raises `n_committed`, flushes: whoever opens the file after a kill finds every
/// committed row and no half one. After the first failed write the file is never touched again: every later call throws
/// the first error, and neither destructor nor program exit write to it.
class TimeSeriesFile {
 public:
  /// Creates (or replaces) `path`; its folder must exist. end_row() commits by itself each `rows_per_commit` rows.
  /// Throws proto::Error: cannot_create with the path and the reason.
  static TimeSeriesFile create(const std::string& path, const std::vector<Column>& columns,
                               const Attributes& attributes = {}, std::size_t rows_per_commit = 20);
  /// Goes on with the file that an earlier process made by create() with the same columns: its first `n_rows` rows
  /// stay (they must be committed there), later ones are gone. Works on a copy that takes the name of `path` at the
  /// end. Throws proto::Error: missing_input, bad_data for a file that does not hold them, cannot_create, io_error.
  static TimeSeriesFile resume(const std::string& path, std::uint64_t n_rows, const std::vector<Column>& columns,
                               const Attributes& attributes = {}, std::size_t rows_per_commit = 20);
  TimeSeriesFile(TimeSeriesFile&&) noexcept;
  TimeSeriesFile& operator=(TimeSeriesFile&&) noexcept;
  /// Closes without throwing; rows not yet committed are lost. Call close() to have them written and errors told.
  ~TimeSeriesFile();

  /// Sets a column of the current row; the length must be the product of the column's shape.
  /// Throws proto::Error (internal) for an unknown name (with the nearest one) or another length; the object survives.
  void put(const std::string& column, Span<const double> values);
  void put(const std::string& column, double value);
  /// Ends the row; it stays in memory until the next commit. Throws (internal) naming a column that was not put,
  /// (io_error) when a due commit fails.
  void end_row();
  /// Makes every ended row safe now. Throws proto::Error (io_error): path, reason, the number of rows that are safe.
  void commit();
  /// The same, and safe against a loss of power.
  void synchronise();
  /// Commits and closes; nothing may follow.
  void close();

  std::uint64_t n_rows() const;
  std::uint64_t n_committed() const;

 private:
  struct Data;
  explicit TimeSeriesFile(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace proto
