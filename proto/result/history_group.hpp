// The columns of one history inside an output file: rows are gathered in memory and written in blocks. Internal.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "proto/result/output_file.hpp"
#include "proto/result/reader.hpp"
#include "proto/result/time_series.hpp"

namespace proto::hdf5 {

class HistoryGroup {
 public:
  /// Creates group (unless "/"), datasets and the counter `n_committed`.
  HistoryGroup(OutputFile& file, const std::string& group, const std::vector<Column>& columns);

  /// Takes over the first `n_rows` rows of the group of the same name in `source`, before any row of its own.
  void continue_from(OutputFile& file, const ResultReader& source, std::uint64_t n_rows);

  void put(const std::string& column, Span<const double> values);
  void end_row();

  std::uint64_t n_rows() const { return n_committed_ + n_pending_; }
  std::uint64_t n_pending() const { return n_pending_; }
  std::uint64_t n_committed() const { return n_committed_; }
  std::uint64_t pending_bytes() const;

  /// First half of a commit, inside OutputFile::write(): the pending rows. A flush must follow, then mark_committed().
  void write_pending(OutputFile& file);
  /// Second half: the counter. A flush must follow.
  void mark_committed(OutputFile& file);

 private:
  struct Buffer {
    std::string name;
    std::vector<hsize_t> row_shape;
    std::size_t row_length = 1;
    hid_t dataset = -1;
    bool is_put = false;
    std::vector<double> values;  // pending rows, then the current one
  };
  std::string path_of(const std::string& column) const;

  std::vector<Buffer> buffers_;
  std::unordered_map<std::string, std::size_t> index_;
  std::string group_;
  hid_t counter_ = -1;
  std::uint64_t n_pending_ = 0, n_committed_ = 0;
};

}  // namespace proto::hdf5
