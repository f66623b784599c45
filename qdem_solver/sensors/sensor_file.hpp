// sensors.h5: what the sensors of a case measured.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "qdem_solver/sensors/sensor.hpp"

namespace qdem {

/// All sensors of a case, sampled together. A history file (proto/result/time_series.hpp) with the column `time` and
/// a group for every sensor; attributes `<name>.kind` and where it sits.
class SensorFile {
 public:
  /// Creates `path`; displacements count from `reference`. `model` must outlive the object.
  /// Throws proto::Error (cannot_create, bad_data for a sensor that finds nothing to measure).
  SensorFile(const std::string& path, const SensorsSettings& settings, const Model& model, const State& reference,
             proto::Attributes attributes);
  /// Goes on with the file that an earlier process made with the same arguments, from what its exchange() saved.
  SensorFile(const std::string& path, const SensorsSettings& settings, const Model& model, const State& reference,
             proto::Attributes attributes, proto::StateArchive& saved);

  /// When the next sample is due [s].
  double next_time() const { return static_cast<double>(n_samples_) * interval_; }
  /// Takes a sample if one is due at `time` [s]; `contacts` holds the forces of `state`.
  void look(double time, const State& state, const ContactStage& contacts);
  /// The number of samples and what the sensors remember.
  void exchange(proto::StateArchive& archive);
  /// What was sampled is safe against a loss of power.
  void synchronise() { file_->synchronise(); }
  void close() { file_->close(); }

 private:
  /// Makes the sensors; returns the columns of the file and adds where they sit to `attributes`.
  std::vector<proto::Column> make_sensors(const SensorsSettings& settings, const Model& model, const State& reference,
                                          proto::Attributes& attributes);

  double interval_;
  std::int64_t n_samples_ = 0;
  double last_time_ = 0.0;
  std::vector<std::unique_ptr<Sensor>> sensors_;
  std::unique_ptr<proto::TimeSeriesFile> file_;
};

}  // namespace qdem
