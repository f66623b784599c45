// The gap between wheel and rail before they deform.
#pragma once

#include <string>
#include <vector>

#include "fem_solver/contact/patch_grid.hpp"

namespace fem {

/// Height of a body's surface over the distance across the rail, by a natural cubic spline.
class SurfaceProfile {
 public:
  /// Reads two columns y_m, z_m (comma or blank between, `#` starts a comment), z up, y ascending. Throws proto::Error:
  /// missing_input, bad_data with file and line; bad_data for fewer than three points or a table in millimetres (wider
  /// than 1 m).
  explicit SurfaceProfile(const std::string& path);
  /// The same from points.
  SurfaceProfile(std::vector<double> y, std::vector<double> z);

  double height_at(double y) const;  ///< linear beyond the ends [m]
  double lowest_y() const { return y_.front(); }
  double highest_y() const { return y_.back(); }

 private:
  std::vector<double> y_, z_, curvature_;
};

/// Surfaces of a wheel over a rail, at rest above each other.
struct ContactGeometry {
  double wheel_curvature = 0.0;          ///< 1/radius along the rail [1/m]
  double crown_curvature = 0.0;          ///< 1/radius of the rail's crown across, if there are no profiles [1/m]
  std::vector<SurfaceProfile> profiles;  ///< none, or wheel and rail in this order
  double wheel_shift = 0.0;              ///< of the wheel's profile across the rail [m]
};

/// A gap and where the grid's centre lies across the rail.
struct ContactGap {
  PatchField height;      ///< smallest value 0 for surfaces without irregularity [m]
  double centre_y = 0.0;  ///< in the rail profile's coordinate; 0 without profiles [m]
};

/// h = x2/(2 R_wheel) + y2/(2 R_crown), or with profiles x2/(2 R_wheel) + z_wheel(y - shift) - z_rail(y) over its
/// smallest value, the grid centred on the place of that value. Throws proto::Error (bad_data) when the profiles do not
/// overlap or the grid reaches beyond one of them.
ContactGap contact_gap(const ContactGeometry& geometry, const PatchGrid& grid);

}  // namespace fem
