#include "proto/result/history_group.hpp"

#include <algorithm>

namespace proto::hdf5 {
namespace {

// A commit rewrites the last chunk of every column, so a chunk is kept small.
constexpr hsize_t chunk_bytes = 16 * 1024;

std::vector<std::string> names_of(const std::unordered_map<std::string, std::size_t>& index) {
  std::vector<std::string> names;
  for (const auto& entry : index) names.push_back(entry.first);
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

HistoryGroup::HistoryGroup(OutputFile& file, const std::string& group, const std::vector<Column>& columns)
    : group_(group) {
  const bool at_root = group == "/";
  const hid_t home = at_root ? file.id() : file.create_group(group);
  for (const Column& column : columns) {
    Buffer buffer;
    buffer.name = column.name;
    buffer.row_shape.assign(column.shape.begin(), column.shape.end());
    for (const std::size_t extent : column.shape) buffer.row_length *= extent;
    if (buffer.row_length == 0) throw Error(ExitCode::internal, "a column without values", column.name);
    const hsize_t chunk_rows = std::max<hsize_t>(1, chunk_bytes / (buffer.row_length * sizeof(double)));
    buffer.dataset = file.create_dataset(
        {path_of(column.name), H5T_IEEE_F64LE, buffer.row_shape, chunk_rows, column.unit, column.description});
    index_[column.name] = buffers_.size();
    buffers_.push_back(std::move(buffer));
  }
  counter_ = file.create_counter(home, "n_committed");
}

std::string HistoryGroup::path_of(const std::string& column) const {
  return (group_ == "/" ? "/" : group_ + "/") + column;
}

void HistoryGroup::continue_from(OutputFile& file, const ResultReader& source, std::uint64_t n_rows) {
  constexpr std::uint64_t rows_at_once = 4096;
  for (std::uint64_t first = 0; first < n_rows; first += rows_at_once) {
    n_pending_ = std::min(rows_at_once, n_rows - first);
    for (Buffer& buffer : buffers_) buffer.values = source.read_rows(path_of(buffer.name), first, n_pending_).values;
    file.write(pending_bytes(), [&] { write_pending(file), mark_committed(file); });
  }
}

void HistoryGroup::put(const std::string& column, Span<const double> values) {
  const auto found = index_.find(column);
  if (found == index_.end()) {
    const std::string nearest = nearest_name(column, names_of(index_));
    throw Error(ExitCode::internal, "no such column of the history", column,
                nearest.empty() ? "" : "did you mean \"" + nearest + "\"?");
  }
  Buffer& buffer = buffers_[found->second];
  if (values.size() != buffer.row_length) {
    throw Error(ExitCode::internal,
                std::to_string(values.size()) + " values for a column of " + std::to_string(buffer.row_length), column);
  }
  buffer.values.resize(n_pending_ * buffer.row_length);
  buffer.values.insert(buffer.values.end(), values.begin(), values.end());
  buffer.is_put = true;
}

void HistoryGroup::end_row() {
  for (const Buffer& buffer : buffers_) {
    if (!buffer.is_put) throw Error(ExitCode::internal, "a column was not put before the row ended", buffer.name);
  }
  for (Buffer& buffer : buffers_) buffer.is_put = false;
  ++n_pending_;
}

std::uint64_t HistoryGroup::pending_bytes() const {
  std::uint64_t bytes = 0;
  // Beside the rows themselves at most one new chunk and one rewritten chunk per column.
  for (const Buffer& buffer : buffers_) bytes += n_pending_ * buffer.row_length * sizeof(double) + 2 * chunk_bytes;
  return bytes;
}

void HistoryGroup::write_pending(OutputFile& file) {
  if (n_pending_ == 0) return;
  for (Buffer& buffer : buffers_) {
    file.append_rows(buffer.dataset, H5T_NATIVE_DOUBLE, buffer.row_shape, n_committed_, n_pending_,
                     buffer.values.data());
  }
}

void HistoryGroup::mark_committed(OutputFile& file) {
  if (n_pending_ == 0) return;
  file.set_counter(counter_, static_cast<std::int64_t>(n_committed_ + n_pending_));
  for (Buffer& buffer : buffers_) {
    buffer.values.erase(buffer.values.begin(),
                        buffer.values.begin() + static_cast<std::ptrdiff_t>(n_pending_ * buffer.row_length));
  }
  n_committed_ += n_pending_;
  n_pending_ = 0;
}

}  // namespace proto::hdf5
