// Fields on a mesh over time: VTKHDF (UnstructuredGrid, temporal), topology and reference points written once.
//
// ParaView 5.12 and later open the file as it is; for ParaView 5.11 close() writes the sidecar of xdmf.hpp.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proto/result/attributes.hpp"
#include "proto/result/time_series.hpp"
#include "proto/span.hpp"

namespace proto {

/// VTK's numbers and node orders.
enum class CellType : std::uint8_t { vertex = 1, line = 3, triangle = 5, quad = 9, tetrahedron = 10, hexahedron = 12 };

/// Number of nodes of a cell.
std::size_t n_nodes(CellType type);

/// A mesh that stays the same over all steps; displacement is a field.
struct OutputMesh {
  std::vector<double> points;              ///< [3 n_points] reference positions, global frame [m]
  std::vector<std::int64_t> connectivity;  ///< nodes of all cells one after the other
  std::vector<CellType> types;             ///< [n_cells]

  std::size_t n_points() const { return points.size() / 3; }
  std::size_t n_cells() const { return types.size(); }
  /// A mesh of one cell type; the number of cells follows from the length of `connectivity`.
  static OutputMesh of_one_type(std::vector<double> points, std::vector<std::int64_t> connectivity, CellType type);
};

enum class Location { point, cell };

/// One field that every step holds, float32.
struct FieldColumn {
  std::string name;  ///< without "/"
  std::string unit;
  std::string description;
  Location location = Location::point;
  std::size_t components = 1;  ///< 1 scalar, 3 vector, 6 symmetric tensor (xx yy zz xy yz xz), 9 tensor
};

/// A field that does not change: stone number, material.
struct StaticField {
  FieldColumn column;
  std::vector<float> values;  ///< [n][components]
};

struct FieldSeriesOptions {
  OutputMesh mesh;
  std::vector<FieldColumn> fields;
  std::vector<StaticField> static_fields;
  std::vector<Column> histories;  ///< columns of the group /TimeSeries; empty: no such group
  Attributes attributes;          ///< of the file's root
  std::size_t history_rows_per_commit = 20;
};

/// An HDF5 file with the fields of one participant. Every dataset is created by create(); steps are appended only.
///
/// end_step() writes the step, flushes, raises `/VTKHDF/Steps@NSteps`, flushes. Behaviour after a failed write as in
/// TimeSeriesFile. The content depends on nothing but the values given: equal runs give equal bytes.
class FieldSeriesFile {
 public:
  /// Creates (or replaces) `path`. Throws proto::Error: cannot_create; internal for a mesh or field of wrong lengths.
  static FieldSeriesFile create(const std::string& path, const FieldSeriesOptions& options);
  /// Goes on with the file that an earlier process made by create() with the same options: its first `n_steps` steps
  /// and `n_history_rows` rows stay; otherwise as TimeSeriesFile::resume().
  static FieldSeriesFile resume(const std::string& path, std::uint64_t n_steps, std::uint64_t n_history_rows,
                                const FieldSeriesOptions& options);
  FieldSeriesFile(FieldSeriesFile&&) noexcept;
  FieldSeriesFile& operator=(FieldSeriesFile&&) noexcept;
  /// Closes without throwing; a step begun and not ended is dropped.
  ~FieldSeriesFile();

  /// Begins a step at `time` [s]; then put() every field, then end_step().
  void begin_step(double time);
  /// Values [n][components] of one field; throws (internal) for an unknown name or another length.
  void put(const std::string& field, Span<const float> values);
  void put(const std::string& field, const std::vector<double>& values);
  /// Makes the step safe. Throws (internal) naming a field that was not put; (io_error) with path and reason.
  void end_step();

  /// Histories beside the fields: put() and end_row() on it; committed each `history_rows_per_commit` rows through
  /// end_history_row(), with every step, and by close().
  void put_history(const std::string& column, Span<const double> values);
  void put_history(const std::string& column, double value);
  void end_history_row();

  std::uint64_t n_steps() const;         ///< safe in the file
  std::uint64_t n_history_rows() const;  ///< ended; 0 without histories
  /// Commits the ended history rows; all is safe against a loss of power.
  void synchronise();
  /// Commits, closes, and writes the ParaView 5.11 sidecar (xdmf.hpp); nothing may follow.
  void close();

 private:
  struct Data;
  explicit FieldSeriesFile(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

}  // namespace proto
