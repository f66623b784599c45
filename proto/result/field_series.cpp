#include "proto/result/field_series.hpp"

#include <optional>

#include "proto/result/history_group.hpp"
#include "proto/result/vtkhdf_group.hpp"
#include "proto/result/xdmf.hpp"

namespace proto {

struct FieldSeriesFile::Data {
  Data(const std::string& path, const FieldSeriesOptions& options)
      : file(path, options.attributes), fields(file, options), history_rows(options.history_rows_per_commit) {
    if (!options.histories.empty()) history.emplace(file, "/TimeSeries", options.histories);
    file.seal();
  }

  hdf5::HistoryGroup& histories() {
    if (!history) throw Error(ExitCode::internal, "a result file without histories", file.path());
    return *history;
  }

  /// Writes a step if `with_step`, and the pending history rows: values, flush, the history's counter, flush, the
  /// step's counter, flush; so the history is never behind the steps.
  void commit(bool with_step) {
    const std::uint64_t bytes = (with_step ? fields.step_bytes() : 0) + (history ? history->pending_bytes() : 0);
    file.write(bytes, [&] {
      if (with_step) fields.write_step(file);
      if (history) history->write_pending(file);
      file.flush();
      if (history) history->mark_committed(file);
      if (history && with_step) file.flush();
      if (with_step) fields.mark_committed(file);
      file.flush();
    });
  }

  hdf5::OutputFile file;
  hdf5::VtkHdfGroup fields;
  std::optional<hdf5::HistoryGroup> history;
  std::size_t history_rows;
};

FieldSeriesFile::FieldSeriesFile(std::unique_ptr<Data> data) : data_(std::move(data)) {}
FieldSeriesFile::FieldSeriesFile(FieldSeriesFile&&) noexcept = default;
FieldSeriesFile& FieldSeriesFile::operator=(FieldSeriesFile&&) noexcept = default;
FieldSeriesFile::~FieldSeriesFile() = default;

FieldSeriesFile FieldSeriesFile::create(const std::string& path, const FieldSeriesOptions& options) {
  return FieldSeriesFile(std::make_unique<Data>(path, options));
}

FieldSeriesFile FieldSeriesFile::resume(const std::string& path, std::uint64_t n_steps, std::uint64_t n_history_rows,
                                        const FieldSeriesOptions& options) {
  const ResultReader before(path);
  auto data = std::make_unique<Data>(path + ".resumed", options);
  data->fields.continue_from(data->file, before, n_steps);
  if (data->history) data->history->continue_from(data->file, before, n_history_rows);
  data->file.flush();
  data->file.synchronise();
  data->file.rename_to(path);
  return FieldSeriesFile(std::move(data));
}

void FieldSeriesFile::begin_step(double time) {
  data_->fields.begin_step(time);
}
void FieldSeriesFile::put(const std::string& field, Span<const float> values) {
  data_->fields.put(field, values);
}

void FieldSeriesFile::put(const std::string& field, const std::vector<double>& values) {
  const std::vector<float> rounded(values.begin(), values.end());
  data_->fields.put(field, rounded);
}

void FieldSeriesFile::end_step() {
  data_->fields.require_complete();
  data_->commit(true);
}

void FieldSeriesFile::put_history(const std::string& column, Span<const double> values) {
  data_->histories().put(column, values);
}

void FieldSeriesFile::put_history(const std::string& column, double value) {
  data_->histories().put(column, {&value, 1});
}

void FieldSeriesFile::end_history_row() {
  data_->histories().end_row();
  if (data_->histories().n_pending() >= data_->history_rows) data_->commit(false);
}

std::uint64_t FieldSeriesFile::n_steps() const {
  return data_->fields.n_steps();
}

std::uint64_t FieldSeriesFile::n_history_rows() const {
  return data_->history ? data_->history->n_rows() : 0;
}

void FieldSeriesFile::synchronise() {
  data_->commit(false);
  data_->file.synchronise();
}

void FieldSeriesFile::close() {
  data_->commit(false);
  data_->file.close();
  write_xdmf(data_->file.path());
}

}  // namespace proto
