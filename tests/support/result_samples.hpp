// Small result files whose every value follows from its row, so that a reader can tell a wrong one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "proto/result/field_series.hpp"
#include "proto/result/time_series.hpp"

namespace tests {

/// A fresh empty folder under the system's temporary folder, removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "qdem_fem_test_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline constexpr const char* sample_impulse = "seats/seat/impulse";

inline std::vector<proto::Column> sample_columns() {
  return {{"time", "s", "end of the window", {}}, {sample_impulse, "N s", "on the sleeper", {9, 3}}};
}

inline std::vector<double> sample_row(std::size_t row) {
  std::vector<double> values(27);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1000.0 * static_cast<double>(row) + 0.25 * i;
  return values;
}

inline void write_sample_row(proto::TimeSeriesFile& file, std::size_t row) {
  file.put("time", 5e-5 * static_cast<double>(row));
  file.put(sample_impulse, sample_row(row));
  file.end_row();
}

/// `n` tetrahedra in a row, each with its own four points.
inline proto::FieldSeriesOptions sample_fields(std::size_t n) {
  proto::FieldSeriesOptions options;
  std::vector<double> points;
  std::vector<std::int64_t> connectivity;
  for (std::size_t cell = 0; cell < n; ++cell) {
    const double x = static_cast<double>(cell);
    points.insert(points.end(), {x, 0, 0, x + 1, 0, 0, x, 1, 0, x, 0, 1});
    for (std::size_t node = 0; node < 4; ++node) connectivity.push_back(static_cast<std::int64_t>(4 * cell + node));
  }
  options.mesh = proto::OutputMesh::of_one_type(points, connectivity, proto::CellType::tetrahedron);
  options.fields = {{"displacement", "m", "from the reference", proto::Location::point, 3},
                    {"stress", "Pa", "von Mises", proto::Location::cell, 1}};
  options.static_fields = {{{"stone", "1", "number", proto::Location::cell, 1}, std::vector<float>(n, 7.0f)}};
  options.histories = {{"kinetic_energy", "J", "of all bodies", {}}};
  return options;
}

inline float sample_value(std::size_t step, std::size_t index) {
  return static_cast<float>(step) * 512.0f + static_cast<float>(index % 512);
}

inline std::vector<float> sample_values(std::size_t step, std::size_t length) {
  std::vector<float> values(length);
  for (std::size_t i = 0; i < length; ++i) values[i] = sample_value(step, i);
  return values;
}

inline void write_sample_step(proto::FieldSeriesFile& file, std::size_t step, std::size_t n_cells) {
  file.put_history("kinetic_energy", static_cast<double>(step));
  file.end_history_row();
  file.begin_step(1e-3 * static_cast<double>(step));
  file.put("displacement", sample_values(step, 12 * n_cells));
  file.put("stress", sample_values(step, n_cells));
  file.end_step();
}

}  // namespace tests
