#include "proto/result/time_series.hpp"

#include "proto/result/history_group.hpp"

namespace proto {

struct TimeSeriesFile::Data {
  Data(const std::string& path, const std::vector<Column>& columns, const Attributes& attributes, std::size_t rows)
      : file(path, attributes), history(file, "/", columns), rows_per_commit(rows) {
    file.seal();
  }
  hdf5::OutputFile file;
  hdf5::HistoryGroup history;
  std::size_t rows_per_commit;
};

TimeSeriesFile TimeSeriesFile::resume(const std::string& path, std::uint64_t n_rows, const std::vector<Column>& columns,
                                      const Attributes& attributes, std::size_t rows_per_commit) {
  const ResultReader before(path);
  auto data = std::make_unique<Data>(path + ".resumed", columns, attributes, rows_per_commit);
  data->history.continue_from(data->file, before, n_rows);
  data->file.flush();
  data->file.synchronise();
  data->file.rename_to(path);
  return TimeSeriesFile(std::move(data));
}

TimeSeriesFile::TimeSeriesFile(std::unique_ptr<Data> data) : data_(std::move(data)) {}
TimeSeriesFile::TimeSeriesFile(TimeSeriesFile&&) noexcept = default;
TimeSeriesFile& TimeSeriesFile::operator=(TimeSeriesFile&&) noexcept = default;
TimeSeriesFile::~TimeSeriesFile() = default;

TimeSeriesFile TimeSeriesFile::create(const std::string& path, const std::vector<Column>& columns,
                                      const Attributes& attributes, std::size_t rows_per_commit) {
  return TimeSeriesFile(std::make_unique<Data>(path, columns, attributes, rows_per_commit));
}

void TimeSeriesFile::put(const std::string& column, Span<const double> values) {
  data_->history.put(column, values);
}
void TimeSeriesFile::put(const std::string& column, double value) {
  data_->history.put(column, {&value, 1});
}

void TimeSeriesFile::end_row() {
  data_->history.end_row();
  if (data_->history.n_pending() >= data_->rows_per_commit) commit();
}

void TimeSeriesFile::commit() {
  auto& [file, history, rows] = *data_;
  file.write(history.pending_bytes(), [&file = file, &history = history] {
    history.write_pending(file);
    file.flush();
    history.mark_committed(file);
    file.flush();
  });
}

void TimeSeriesFile::synchronise() {
  commit();
  data_->file.synchronise();
}

void TimeSeriesFile::close() {
  commit();
  data_->file.close();
}

std::uint64_t TimeSeriesFile::n_rows() const {
  return data_->history.n_rows();
}
std::uint64_t TimeSeriesFile::n_committed() const {
  return data_->history.n_committed();
}

}  // namespace proto
