// Height of the running surface over the distance along the track.
#pragma once

#include <string>
#include <vector>

namespace fem {

enum class IrregularityKind { none, dipped_joint, corrugation, table };

/// Rail irregularity r(x), positive up [m]. Immutable.
struct Irregularity {
  IrregularityKind kind = IrregularityKind::none;
  double position = 0.0;       ///< dipped joint: of the joint; corrugation: where it begins [m]
  double depth = 0.0;          ///< dipped joint: at the joint [m]; corrugation: amplitude (half peak to peak) [m]
  double length = 1.0;         ///< dipped joint: both ramps together; corrugation: wavelength [m]
  std::vector<double> x;       ///< table: ascending [m]
  std::vector<double> height;  ///< table [m]

  /// Dipped joint: two parabolas that meet in a kink, -depth (1 - 2|x - position|/length)^2.
  /// Corrugation: depth sin(2 pi (x - position)/length) for x > position, faded in over one wavelength.
  /// Table: linear between the points, constant beyond.
  double height_at(double position_along_track) const;
};

/// Reads two columns x_m, height_m (comma or blank between, `#` starts a comment). Throws proto::Error: missing_input,
/// bad_data for a line that is not two finite numbers, fewer than two lines, x that does not ascend.
Irregularity read_irregularity_table(const std::string& path);

}  // namespace fem
