// The result files of one run, as plain arrays.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coupler/analysis/force_chains.hpp"
#include "coupler/analysis/layer.hpp"
#include "proto/result/attributes.hpp"
#include "proto/result/reader.hpp"

namespace coupler::study {

/// One rail seat along its normal, at the window ends.
struct SeatHistory {
  std::string name;
  double interval = 0.0;                 ///< [s]
  std::vector<double> time;              ///< [s]
  std::vector<double> force;             ///< on the sleeper, up is positive, mean over the window before [N]
  std::vector<double> rail, sleeper;     ///< displacement, mean over the cells [m]
  std::vector<double> sleeper_velocity;  ///< [m/s]
};

/// A sensor of kind "stone" or "particle".
struct PointHistory {
  std::string name;
  double interval = 0.0;                                     ///< [s]
  std::vector<double> time;                                  ///< [s]
  std::vector<double> displacement, velocity, acceleration;  ///< [n][3] [m], [m/s], [m/s2]
};

/// Pressure on the cells of the sleeper's bottom.
struct PressureHistory {
  std::string name;
  std::size_t n_x = 0, n_y = 0;                ///< cells along and across the track
  double cell_length = 0.0, cell_width = 0.0;  ///< [m]
  std::vector<double> time;                    ///< [s]
  std::vector<double> pressure;                ///< [n][n_x][n_y] [Pa]
  std::vector<double> force;                   ///< [n] [N]
};

/// What presses the sleeper down, over time.
struct Load {
  std::string source;               ///< "rail seats", "sleeper bottom"
  std::vector<double> time, force;  ///< [s], [N]: down is positive
  std::size_t peak = 0;             ///< row of the largest force
  std::size_t unloaded = 0;         ///< row of the least force after it
};

/// Contacts at every output.
struct ContactHistory {
  std::vector<double> time;                                  ///< [s]
  std::vector<std::vector<analysis::PairContact>> contacts;  ///< [n]
};

/// Opens what is there of coupling.h5, qdem.h5, sensors.h5 and contacts.h5; only whole rows are read, so a run that was
/// stopped can be analysed. Every function returns nothing where the record is missing, and throws proto::Error
/// (bad_data) where it is damaged.
class RunFiles {
 public:
  /// Throws proto::Error: missing_input (no folder, none of the files), bad_data (not a result file).
  explicit RunFiles(const std::string& folder);

  const std::optional<proto::ResultReader>& qdem() const { return qdem_; }
  const std::optional<proto::ResultReader>& coupling() const { return coupling_; }
  /// Case name, hash and text of the run.
  proto::Attributes provenance() const;

  std::vector<SeatHistory> seats() const;
  std::vector<PointHistory> points() const;
  std::vector<PressureHistory> pressures() const;
  /// The first sensor of kind "bottom": every cell is a point.
  std::optional<analysis::Motion> bottom() const;
  /// The first sensor of kind "stones".
  std::optional<analysis::Motion> stones() const;
  /// Of a sensor on the bottom, else the box of the sleeper in qdem.h5.
  std::optional<analysis::Footprint> footprint() const;
  /// The seats' force, else the contact force on the bottom from a pressure sensor.
  std::optional<Load> load() const;
  std::optional<ContactHistory> contacts() const;
  std::set<int> stone_numbers() const;  ///< bodies of qdem.h5 that are no sleeper; empty without that file

 private:
  std::vector<std::string> sensors_of(const std::string& kind) const;
  std::vector<double> sensor_rows(const std::string& column) const;

  std::optional<proto::ResultReader> coupling_, qdem_, sensors_, contacts_;
};

}  // namespace coupler::study
