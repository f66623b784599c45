// A wheel as a body of revolution about the y axis, its centre at the origin, the contact point below at x = 0.
#pragma once

#include <array>
#include <vector>

#include "fem_solver/assembly/solid_mesh.hpp"
#include "fem_solver/model/settings.hpp"

namespace fem {

/// Half plane through the axle cut into quadrilaterals.
struct Meridian {
  std::vector<Eigen::Vector2d> vertices;  ///< (y across, r) [m]; y = 0 is the running circle
  /// Corners in lexicographic order, y first, then from outside to the axle.
  std::vector<std::array<int, 4>> quads;
  double bore_radius = 0.0;  ///< [m]
  int contact_quad = 0;      ///< whose outer side carries the contact

  /// Of the solid of revolution, exact for straight edges (Pappus) [m3].
  double volume() const;
  /// Integral of r^2 over the volume: moment of inertia about the axle per density [m5].
  double second_moment() const;
};

/// Hub and web as layers between the radii of the settings, the rim above them with tread and flange; rim and tread
/// blocks lie over the web and beside it. Throws proto::Error (bad_data) when the web reaches to the tread.
Meridian wheel_meridian(const SolidWheelSettings& wheel, double radius);

/// Angles from the contact point around the wheel [rad]: fine there, coarse above, symmetric.
std::vector<double> wheel_angles(double finest, double coarsest);

/// The meridian turned about the axle; columns of elements between `angles`, which span a full turn without repeating
/// the first one.
HexahedronMesh revolved(const Meridian& meridian, const std::vector<double>& angles);

}  // namespace fem
