#include "qdem_solver/sensors/sensor_settings.hpp"

#include <algorithm>
#include <utility>

namespace qdem {
namespace {

using proto::Range;
using proto::Section;

constexpr std::pair<SensorKind, const char*> kinds[] = {{SensorKind::stone, "stone"},
                                                        {SensorKind::particle, "particle"},
                                                        {SensorKind::pressure, "pressure"},
                                                        {SensorKind::stones, "stones"},
                                                        {SensorKind::bottom, "bottom"}};

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const auto& kind : kinds) names.push_back(kind.second);
  return names;
}

SensorKind kind_of(const std::string& name) {
  return std::find_if(std::begin(kinds), std::end(kinds), [&](const auto& kind) { return kind.second == name; })->first;
}

SensorSettings read_sensor(const Section& section) {
  SensorSettings sensor;
  sensor.name = section.text("name");
  if (sensor.name.empty() || sensor.name.find_first_of("/.") != std::string::npos) {
    section.fail("name", "it names a group of the result file", "use letters, digits, _ and -");
  }
  sensor.kind = kind_of(section.choice("kind", kind_names()));
  if (sensor.kind == SensorKind::pressure || sensor.kind == SensorKind::bottom) {
    const auto cells = section.integers("cells", 2, Range::between(1, 1000));
    sensor.cells = {static_cast<int>(cells[0]), static_cast<int>(cells[1])};
  } else if (sensor.kind != SensorKind::stones) {
    const auto point = section.numbers("point_m", 3);
    sensor.point = {point[0], point[1], point[2]};
  }
  return sensor;
}

}  // namespace

const char* name_of(SensorKind kind) {
  return std::find_if(std::begin(kinds), std::end(kinds), [&](const auto& k) { return k.first == kind; })->second;
}

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
