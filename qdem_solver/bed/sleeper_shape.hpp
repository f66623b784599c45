// Sleepers: their cross-sections along the length, and the mesh of half of one.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "qdem_solver/model/model.hpp"

namespace qdem::bed {

/// Cross-section of a sleeper: a trapezoid, symmetric about the vertical.
struct SleeperSection {
  double place = 0.0;         ///< distance from the track's centre [m]
  double height = 0.0;        ///< over the plane bottom [m]
  double bottom_width = 0.0;  ///< along the track [m]
  double top_width = 0.0;     ///< along the track [m]
};

/// Half a sleeper from the symmetry plane to its end: cross-sections, between which every length changes linearly.
struct SleeperShape {
  std::vector<SleeperSection> sections;  ///< two or more, ascending; the first at place 0

  bool is_tapered() const { return sections.size() > 2; }
  double half_length() const { return sections.back().place; }  ///< [m]
  double height() const;                                        ///< the largest: that of the rail seat [m]
  double width() const;                                         ///< the largest [m]
  double bottom_area() const;                                   ///< of the half [m2]
  double volume() const;                                        ///< of the half, closed form [m3]
  /// Where the top is plane at height(): first and last place [m].
  std::pair<double, double> seat_range() const;
};

/// A box: both sections alike.
SleeperShape box_sleeper(double length, double width, double height);

/// A tapered mono-block sleeper: `seat` from `seat_range`.first to .second, `centre` at 0 and `end` at the end. The
/// places of the three are not read.
SleeperShape tapered_sleeper(double length, std::pair<double, double> seat_range, const SleeperSection& centre,
                             const SleeperSection& seat, const SleeperSection& end);

/// Two tapered PC sleepers by name, "3PR" (gauge 1067 mm) and "B70" (1435 mm); README.md says what of their dimensions
/// is published and what is ours.
SleeperShape known_sleeper(const std::string& name);

/// The half sleeper, top of the rail seat at z = 0, x along the track, cut at y = 0: `cells` bricks through the height
/// and as nearly cubic ones as fit between the sections, six tetrahedra a brick. The sides between two sections are
/// twisted a little, so the mesh's volume differs from the shape's by an error of second order in the bricks' size.
Template sleeper_mesh(const std::string& name, const SleeperShape& shape, int cells);

/// A box low..high [m] cut into cells of about `cell` [m] (a whole number along each axis), six tetrahedra a cell
/// around its main diagonal, so that neighbouring cells match.
Template box_shape(const std::string& name, const Eigen::Vector3d& low, const Eigen::Vector3d& high, double cell);

}  // namespace qdem::bed
