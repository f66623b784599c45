// The outline of a rail's cross-section as a closed polygon.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace fem {

/// Figures of a cross-section about its centroid.
struct SectionProperties {
  double area = 0.0;              ///< [m2]
  double centroid_height = 0.0;   ///< above the foot's bottom face [m]
  double inertia_vertical = 0.0;  ///< second moment for bending in the vertical plane [m4]
  double inertia_lateral = 0.0;   ///< second moment for bending in the horizontal plane [m4]
};

/// Area integrals of polygons, edge by edge (Green's theorem): exact for straight edges.
struct SectionSums {
  double area = 0.0, first = 0.0, second_z = 0.0, second_y = 0.0;
  /// Edge from `a` to `b` of a polygon that is run through counter-clockwise; (y, z) [m].
  void add_edge(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  /// The lateral one about y = 0.
  SectionProperties properties() const;
};

/// Simple polygon, counter-clockwise, first point not repeated: y lateral from the plane of symmetry, z up from the
/// foot's bottom [m].
struct RailOutline {
  std::vector<Eigen::Vector2d> points;

  SectionProperties properties() const;
  /// Ascending z where the vertical line at `y` meets the outline [m].
  std::vector<double> heights_at(double y) const { return crossings(0, y); }
  /// Ascending y where the horizontal line at `z` meets the outline [m].
  std::vector<double> laterals_at(double z) const { return crossings(1, z); }
  double height() const;  ///< [m]

 private:
  std::vector<double> crossings(int axis, double value) const;
};

/// Reads a profile: two columns, lateral y and height z of the points along the outline in millimetres, z pointing
/// down, comma or blank between, `#` starts a comment. The origin is free; either sense of running is taken; the last
/// point repeats the first. Throws proto::Error: missing_input; bad_data, naming the line, for what is not two finite
/// numbers, for an outline that is not closed, crosses itself, is in metres, has its columns exchanged, stands on its
/// head, or is not symmetric within 0.5 mm.
RailOutline read_rail_outline(const std::string& path);

}  // namespace fem
