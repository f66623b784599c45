#include "qdem_solver/sensors/sensor_settings.hpp"

namespace qdem {
namespace {

using proto::Range;
using proto::Section;

SensorSettings read_sensor(const Section& section) {
  SensorSettings sensor;
  sensor.name = section.text("name");
  if (sensor.name.empty() || sensor.name.find_first_of("/.") != std::string::npos) {
    section.fail("name", "it names a group of the result file", "use letters, digits, _ and -");
  }
  const std::string kind = section.choice("kind", {"stone", "particle", "pressure"});
  if (kind == "pressure") {
    sensor.kind = SensorKind::pressure;
    const auto cells = section.integers("cells", 2, Range::between(1, 1000));
    sensor.cells = {static_cast<int>(cells[0]), static_cast<int>(cells[1])};
  } else {
    sensor.kind = kind == "stone" ? SensorKind::stone : SensorKind::particle;
    const auto point = section.numbers("point_m", 3);
    sensor.point = {point[0], point[1], point[2]};
  }
  return sensor;
}

}  // namespace

SensorsSettings read_sensors(const Section& qdem) {
  SensorsSettings sensors;
  sensors.interval = qdem.number_or("sensor_interval_s", 0.0, Range::positive());
  for (const Section& section : qdem.sections("sensor")) {
    sensors.list.push_back(read_sensor(section));
    for (std::size_t i = 0; i + 1 < sensors.list.size(); ++i) {
      if (sensors.list[i].name == sensors.list.back().name) section.fail("name", "another sensor has this name");
    }
  }
  if (!sensors.list.empty() && !(sensors.interval > 0)) {
    qdem.fail("sensor_interval_s", "there are sensors, but no interval", "give the time between samples");
  }
  return sensors;
}

}  // namespace qdem
