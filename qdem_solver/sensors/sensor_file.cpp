#include "qdem_solver/sensors/sensor_file.hpp"

#include <utility>

namespace qdem {
namespace {

std::unique_ptr<Sensor> make_sensor(const SensorSettings& settings, const Model& model, const State& reference) {
  switch (settings.kind) {
    case SensorKind::stone:
      return make_stone_sensor(settings, model, reference);
    case SensorKind::particle:
      return make_particle_sensor(settings, model, reference);
    case SensorKind::stones:
      return make_stones_sensor(settings, model);
    case SensorKind::bottom:
      return make_bottom_sensor(settings, model, reference);
    default:
      return make_pressure_sensor(settings, model, reference);
  }
}

}  // namespace

std::vector<proto::Column> SensorFile::make_sensors(const SensorsSettings& settings, const Model& model,
                                                    const State& reference, proto::Attributes& attributes) {
  std::vector<proto::Column> columns = {{"time", "s", "of the sample", {}}};
  for (const SensorSettings& sensor : settings.list) {
    sensors_.push_back(make_sensor(sensor, model, reference));
    for (auto& column : sensors_.back()->columns()) columns.push_back(std::move(column));
    attributes.emplace_back(sensor.name + ".kind", std::string(name_of(sensor.kind)));
    for (auto& fact : sensors_.back()->place()) attributes.push_back(std::move(fact));
  }
  return columns;
}

SensorFile::SensorFile(const std::string& path, const SensorsSettings& settings, const Model& model,
                       const State& reference, proto::Attributes attributes)
    : interval_(settings.interval) {
  const auto columns = make_sensors(settings, model, reference, attributes);
  file_ = std::make_unique<proto::TimeSeriesFile>(proto::TimeSeriesFile::create(path, columns, attributes));
}

SensorFile::SensorFile(const std::string& path, const SensorsSettings& settings, const Model& model,
                       const State& reference, proto::Attributes attributes, proto::StateArchive& saved)
    : interval_(settings.interval) {
  const auto columns = make_sensors(settings, model, reference, attributes);
  exchange(saved);
  file_ = std::make_unique<proto::TimeSeriesFile>(
      proto::TimeSeriesFile::resume(path, static_cast<std::uint64_t>(n_samples_), columns, attributes));
}

void SensorFile::exchange(proto::StateArchive& archive) {
  archive("sensors/samples", n_samples_);
  archive("sensors/last_time", last_time_);
  for (const auto& sensor : sensors_) sensor->exchange(archive);
}

void SensorFile::look(double time, const State& state, const ContactStage& contacts) {
  if (time < next_time() - 1e-6 * interval_) return;
  file_->put("time", time);
  const double elapsed = n_samples_ > 0 ? time - last_time_ : 0.0;
  for (const auto& sensor : sensors_) sensor->put(*file_, state, contacts, elapsed);
  file_->end_row();
  last_time_ = time;
  ++n_samples_;
}

}  // namespace qdem
