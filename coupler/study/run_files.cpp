#include "coupler/study/run_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "coupler/study/mesh.hpp"
#include "coupler/study/stone_mesh.hpp"
#include "proto/error.hpp"

namespace coupler::study {
namespace {

using proto::ResultReader;

std::optional<ResultReader> open_if_there(const std::string& path) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  return ResultReader(path);
}

/// A history without a whole row is as good as none.
std::optional<ResultReader> open_history(const std::string& path) {
  auto file = open_if_there(path);
  if (file && file->n_committed() == 0) file.reset();
  return file;
}

double interval_of(const std::vector<double>& time) {
  return time.size() < 2 ? 0.0 : (time.back() - time.front()) / static_cast<double>(time.size() - 1);
}

std::vector<std::array<double, 3>> first_row(const std::vector<double>& values, std::size_t n) {
  std::vector<std::array<double, 3>> places(n);
  for (std::size_t i = 0; i < n; ++i) places[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return places;
}

analysis::Footprint read_footprint(const ResultReader& sensors, const std::string& name) {
  const auto at = [&](const char* key) { return sensors.number("/", name + key); };
  return {at(".x_min_m"), at(".x_max_m"), at(".y_min_m"), at(".y_max_m"), at(".z_m")};
}

/// Values [rows][cells][3] of a seat.
struct SeatRows {
  std::vector<double> values;
  std::size_t n_cells;

  /// Sum over the cells along the normal.
  double normal(std::size_t row) const {
    double sum = 0.0;
    for (std::size_t cell = 0; cell < n_cells; ++cell) sum += values[3 * (row * n_cells + cell) + 2];
    return sum;
  }
  double mean_normal(std::size_t row) const { return normal(row) / static_cast<double>(n_cells); }
};

Load with_extremes(Load load) {
  const auto& f = load.force;
  load.peak = static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin());
  const auto after = f.begin() + static_cast<std::ptrdiff_t>(load.peak);
  load.unloaded = static_cast<std::size_t>(std::min_element(after, f.end()) - f.begin());
  return load;
}

}  // namespace

RunFiles::RunFiles(const std::string& folder)
    : coupling_(open_history(folder + "/coupling.h5")),
      qdem_(open_if_there(folder + "/qdem.h5")),
      sensors_(open_history(folder + "/sensors.h5")),
      contacts_(open_history(folder + "/contacts.h5")) {
  if (coupling_ || qdem_ || sensors_) return;
  const bool is_there = std::filesystem::is_directory(folder);
  throw proto::Error(proto::ExitCode::missing_input,
                     is_there ? "there is no coupling.h5, qdem.h5 or sensors.h5 with results" : "no such folder",
                     folder, "name the output folder of a run");
}

proto::Attributes RunFiles::provenance() const {
  const auto& source = coupling_ ? coupling_ : qdem_ ? qdem_ : sensors_;
  proto::Attributes attributes;
  for (const char* key : {"case_name", "case_hash", "case_text"}) {
    if (source->has_attribute("/", key)) attributes.emplace_back(key, source->text("/", key));
  }
  return attributes;
}

std::vector<SeatHistory> RunFiles::seats() const {
  std::vector<SeatHistory> seats;
  const auto n = coupling_ ? coupling_->n_committed() : 0;
  if (n < 2) return seats;  // row 0 holds the initial values
  for (const auto& name : coupling_->members("/seats")) {
    const auto rows = [&](const std::string& column) {
      auto array = coupling_->read_rows("/seats/" + name + "/" + column, n);
      return SeatRows{std::move(array.values), array.shape[1]};
    };
    SeatHistory seat;
    seat.name = name;
    seat.time = coupling_->read_rows("/time", n).values;
    seat.interval = interval_of(seat.time);
    const auto impulse = rows("impulse"), rail = rows("rail_displacement"), sleeper = rows("sleeper_displacement"),
               velocity = rows("sleeper_velocity");
    for (std::size_t row = 0; row < n; ++row) {
      seat.force.push_back(impulse.normal(row) / seat.interval);
      seat.rail.push_back(rail.mean_normal(row));
      seat.sleeper.push_back(sleeper.mean_normal(row));
      seat.sleeper_velocity.push_back(velocity.mean_normal(row));
    }
    seat.force[0] = seat.force[1];  // no window went before
    seats.push_back(std::move(seat));
  }
  return seats;
}

std::vector<std::string> RunFiles::sensors_of(const std::string& kind) const {
  std::vector<std::string> names;
  if (!sensors_) return names;
  for (const auto& name : sensors_->members("/")) {
    if (sensors_->has_attribute("/", name + ".kind") && sensors_->text("/", name + ".kind") == kind)
      names.push_back(name);
  }
  return names;
}

std::vector<double> RunFiles::sensor_rows(const std::string& column) const {
  return sensors_->read_rows(column, sensors_->n_committed()).values;
}

std::vector<PointHistory> RunFiles::points() const {
  std::vector<PointHistory> points;
  for (const char* kind : {"stone", "particle"}) {
    for (const auto& name : sensors_of(kind)) {
      auto time = sensor_rows("/time");
      const double interval = interval_of(time);
      points.push_back({name, interval, std::move(time), sensor_rows("/" + name + "/displacement"),
                        sensor_rows("/" + name + "/velocity"), sensor_rows("/" + name + "/acceleration")});
    }
  }
  return points;
}

std::vector<PressureHistory> RunFiles::pressures() const {
  std::vector<PressureHistory> result;
  for (const auto& name : sensors_of("pressure")) {
    const auto shape = sensors_->shape("/" + name + "/pressure");
    result.push_back({name, shape[1], shape[2], sensors_->number("/", name + ".cell_length_m"),
                      sensors_->number("/", name + ".cell_width_m"), sensor_rows("/time"),
                      sensor_rows("/" + name + "/pressure"), sensor_rows("/" + name + "/force")});
  }
  return result;
}

std::optional<analysis::Motion> RunFiles::bottom() const {
  const auto names = sensors_of("bottom");
  if (names.empty()) return std::nullopt;
  const std::string& name = names.front();
  analysis::Motion motion;
  motion.time = sensor_rows("/time");
  motion.interval = interval_of(motion.time);
  const auto shape = sensors_->shape("/" + name + "/velocity");
  const auto box = read_footprint(*sensors_, name);
  for (std::size_t i = 0; i < shape[1]; ++i) {
    for (std::size_t j = 0; j < shape[2]; ++j) {
      const double along = (static_cast<double>(i) + 0.5) / static_cast<double>(shape[1]);
      const double across = (static_cast<double>(j) + 0.5) / static_cast<double>(shape[2]);
      motion.place.push_back(
          {box.x_min + along * (box.x_max - box.x_min), box.y_min + across * (box.y_max - box.y_min), box.z});
    }
  }
  motion.displacement = sensor_rows("/" + name + "/displacement");
  motion.velocity = sensor_rows("/" + name + "/velocity");
  return motion;
}

std::optional<analysis::Motion> RunFiles::stones() const {
  const auto names = sensors_of("stones");
  if (names.empty()) return std::nullopt;
  const std::string group = "/" + names.front();
  analysis::Motion motion;
  motion.time = sensor_rows("/time");
  motion.interval = interval_of(motion.time);
  motion.displacement = sensor_rows(group + "/position");
  motion.velocity = sensor_rows(group + "/velocity");
  const std::size_t n = sensors_->shape(group + "/position")[1];
  motion.place = first_row(motion.displacement, n);
  for (std::size_t i = 0; i < motion.displacement.size(); ++i) {
    motion.displacement[i] -= motion.place[i / 3 % n][i % 3];
  }
  return motion;
}

std::optional<analysis::Footprint> RunFiles::footprint() const {
  for (const char* kind : {"bottom", "pressure"}) {
    for (const auto& name : sensors_of(kind)) return read_footprint(*sensors_, name);
  }
  if (!qdem_) return std::nullopt;
  return sleeper_box(*qdem_);
}

std::optional<Load> RunFiles::load() const {
  Load load;
  const auto seats = this->seats();
  for (const auto& seat : seats) {
    if (load.force.empty()) load.time = seat.time, load.force.assign(seat.time.size(), 0.0);
    for (std::size_t i = 0; i < load.force.size(); ++i) load.force[i] -= seat.force[i];
  }
  load.source = "rail seats";
  if (load.force.empty()) {
    auto all = pressures();
    if (!all.empty()) load = {"sleeper bottom", std::move(all[0].time), std::move(all[0].force)};
  }
  if (load.force.empty()) return std::nullopt;
  return with_extremes(std::move(load));
}

std::optional<ContactHistory> RunFiles::contacts() const {
  if (!contacts_) return std::nullopt;
  const auto n = contacts_->n_committed();
  const auto rows = [&](const char* column) { return contacts_->read_rows(column, n).values; };
  const auto time = rows("/time"), a = rows("/body_a"), b = rows("/body_b"), force = rows("/force");
  std::map<double, std::vector<analysis::PairContact>> outputs;
  if (qdem_) {  // an output without a contact has no row
    for (const double output : qdem_->read_rows("/VTKHDF/Steps/Values", qdem_->n_steps()).values) outputs[output];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double magnitude = std::hypot(force[3 * i], force[3 * i + 1], force[3 * i + 2]);
    outputs[time[i]].push_back({static_cast<int>(a[i]), static_cast<int>(b[i]), magnitude});
  }
  ContactHistory history;
  for (auto& [output, contacts] : outputs) {
    history.time.push_back(output);
    history.contacts.push_back(std::move(contacts));
  }
  return history;
}

std::set<int> RunFiles::stone_numbers() const {
  std::set<int> numbers;
  if (!qdem_) return numbers;
  const Mesh mesh = read_mesh(*qdem_);
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    if (mesh.is_stone(cell)) numbers.insert(static_cast<int>(mesh.bodies[cell]));
  }
  return numbers;
}

}  // namespace coupler::study
