// The group /VTKHDF of an output file: mesh, fields and the bookkeeping of the steps. Internal.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "proto/result/field_series.hpp"
#include "proto/result/output_file.hpp"
#include "proto/result/reader.hpp"

namespace proto::hdf5 {

class VtkHdfGroup {
 public:
  /// Writes the mesh and the static fields, creates everything that the steps extend. Throws (internal) for a mesh or a
  /// field whose lengths do not fit.
  VtkHdfGroup(OutputFile& file, const FieldSeriesOptions& options);

  /// Takes over the first `n_steps` steps of `source`, before any step of its own.
  void continue_from(OutputFile& file, const ResultReader& source, std::uint64_t n_steps);

  void begin_step(double time);
  void put(const std::string& field, Span<const float> values);
  /// Throws (internal) when no step is begun or a field is missing.
  void require_complete() const;

  std::uint64_t n_steps() const { return n_steps_; }
  std::uint64_t step_bytes() const;

  /// First half of a commit, inside OutputFile::write(): values and offsets. A flush must follow, then
  /// mark_committed().
  void write_step(OutputFile& file);
  /// Second half: NSteps. A flush must follow.
  void mark_committed(OutputFile& file);

 private:
  struct Slot {
    FieldColumn column;
    std::size_t n_rows = 0;
    std::vector<hsize_t> row_shape;
    hid_t dataset = -1, offsets = -1;
    std::vector<float> values;  // of the step begun; empty: not put
    bool is_put = false;
  };
  /// One int64 per step: `advance` * step number, or the constant `value`.
  struct Bookkeeping {
    hid_t dataset = -1;
    std::vector<hsize_t> row_shape;
    std::int64_t value = 0, advance = 0;
  };

  void create_field(OutputFile& file, const FieldColumn& column);
  void write_static_field(OutputFile& file, const StaticField& field);
  hid_t add_bookkeeping(OutputFile& file, const std::string& name, std::int64_t value, std::int64_t advance,
                        bool as_table = false);

  std::size_t n_points_ = 0, n_cells_ = 0;
  std::vector<Slot> slots_;
  std::unordered_map<std::string, std::size_t> index_;
  std::vector<Bookkeeping> bookkeeping_;
  hid_t times_ = -1, counter_ = -1;
  std::optional<double> time_;
  std::uint64_t n_steps_ = 0;
};

}  // namespace proto::hdf5
