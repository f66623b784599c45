// One measuring device in the bed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "proto/result/attributes.hpp"
#include "proto/result/state_archive.hpp"
#include "proto/result/time_series.hpp"
#include "qdem_solver/contact/contact_stage.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/sensors/sensor_settings.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Columns of the result file, under the sensor's name.
  virtual std::vector<proto::Column> columns() const = 0;
  /// Where it sits, for the result file.
  virtual proto::Attributes place() const = 0;
  /// Puts the values at `state` into the current row. `elapsed`: since the last row, 0 in the first [s].
  virtual void put(proto::TimeSeriesFile& file, const State& state, const ContactStage& contacts, double elapsed) = 0;
  /// What it remembers from one row to the next.
  virtual void exchange(proto::StateArchive&) {}
};

/// Sensing stone: displacement, velocity and mean acceleration of the centre of mass, and rotation as a vector, all
/// from `reference` on. The stone is the one whose centre is nearest to the point.
std::unique_ptr<Sensor> make_stone_sensor(const SensorSettings& settings, const Model& model, const State& reference);

/// The same, without rotation, of the surface particle of any body that is nearest to the point.
std::unique_ptr<Sensor> make_particle_sensor(const SensorSettings& settings, const Model& model,
                                             const State& reference);

/// Sensing sleeper: mean upward contact pressure on each cell of its bottom. Every contact force on a bottom particle
/// belongs to the cell under it, in equal parts where cells meet: the cells' forces sum up to the whole.
std::unique_ptr<Sensor> make_pressure_sensor(const SensorSettings& settings, const Model& model,
                                             const State& reference);

/// Position and velocity of every stone's centre of mass, for spectra over the whole layer. Accelerations follow from
/// the velocities; they would make the file half as large again. Throws proto::Error (bad_data) where there is no
/// stone.
std::unique_ptr<Sensor> make_stones_sensor(const SensorSettings& settings, const Model& model);

/// Mean displacement and velocity of each cell of the sleeper's bottom.
/// Throws proto::Error (bad_data) for a cell without particles.
std::unique_ptr<Sensor> make_bottom_sensor(const SensorSettings& settings, const Model& model, const State& reference);

}  // namespace qdem
