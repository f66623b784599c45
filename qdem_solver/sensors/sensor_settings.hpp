// `[[qdem.sensor]]`: what is measured in the bed besides the fields.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"

namespace qdem {

enum class SensorKind { stone, particle, pressure, stones, bottom };

struct SensorSettings {
  std::string name;
  SensorKind kind = SensorKind::stone;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< stone, particle: where it is at time 0 [m]
  std::array<int, 2> cells{};                       ///< pressure, bottom: along and across the track
};

/// The case's word for a kind.
const char* name_of(SensorKind kind);

struct SensorsSettings {
  double interval = 0.0;  ///< between samples [s]
  std::vector<SensorSettings> list;
};

/// Reads sensor_interval_s and [[qdem.sensor]] name, kind, point_m (stone, particle), cells (pressure, bottom) of
/// `[qdem]`.
/// Throws proto::Error (config).
SensorsSettings read_sensors(const proto::Section& qdem);

}  // namespace qdem
