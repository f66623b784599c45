// Height of the running surfaces of rail and wheel over the distance along the track.
#pragma once

#include <string>
#include <vector>

namespace fem {

enum class IrregularityKind { none, dipped_joint, corrugation, table, fresh_flat, rounded_flat };

/// What the wheel is displaced by against the rail, r(x), positive up [m]: irregularities of the rail, and those of the
/// wheel as its centre follows them when it rolls over a plane. Immutable.
struct Irregularity {
  IrregularityKind kind = IrregularityKind::none;
  double position = 0.0;  ///< of the joint; where the corrugation begins; where the flat's middle meets the rail [m]
  double depth = 0.0;     ///< at the joint or of a rounded flat; amplitude (half peak to peak) of corrugation [m]
  double length = 1.0;    ///< of both ramps of the joint together, or of the flat; wavelength of corrugation [m]
  double radius = 0.0;    ///< flats: of the wheel; they return after every turn of it [m]
  std::vector<double> x;  ///< table: ascending [m]
  std::vector<double> height;  ///< table [m]

  /// Dipped joint: two parabolas that meet in a kink, -depth (1 - 2|x - position|/length)^2.
  /// Corrugation: depth sin(2 pi (x - position)/length) for x > position, faded in over one wavelength.
  /// Fresh flat, a chord of the wheel: the wheel tips over the chord's first edge, falls until the chord lies on the
  /// rail and tips over the second edge; at the distance s from the flat's middle -(R - sqrt(R^2 - (length/2 -
  /// |s|)^2)), which is -length^2/(8 R) at the middle. Geometry of a rolling polygon; Wu and Thompson, Journal of Sound
  /// and Vibration 251 (2002), use the same path. Rounded flat: -depth/2 (1 + cos(2 pi s/length)) (Newton and Clark,
  /// Journal of Mechanical Engineering Science 21 (1979)). Table: linear between the points, constant beyond.
  double height_at(double position_along_track) const;
};

/// Reads two columns x_m, height_m (comma or blank between, `#` starts a comment). Throws proto::Error: missing_input,
/// bad_data for a line that is not two finite numbers, fewer than two lines, x that does not ascend.
Irregularity read_irregularity_table(const std::string& path);

}  // namespace fem
