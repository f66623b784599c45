// The interface as the case defines it: `[[rail_seat]]`, one rigid frame and its pad cells.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "proto/error.hpp"
#include "proto/pad/pad_law.hpp"

namespace proto {

/// One rail seat. Components along the seat axes, in this order everywhere on the wire:
/// 1 longitudinal (along the rail), 2 lateral, 3 normal (from sleeper to rail).
struct RailSeat {
  std::string name;
  Eigen::Vector3d origin;        ///< centre of the pad, global frame [m]
  Eigen::Matrix3d axes;          ///< columns: unit vectors of the seat axes in the global frame, right-handed
  Eigen::Vector2d half_lengths;  ///< half the pad's length along axes 1 and 2 [m]
  Eigen::Vector2i cells;         ///< n x m cells along axes 1 and 2
  Eigen::Vector3d stiffness;     ///< whole pad, per axis [N/m]
  Eigen::Vector3d damping;       ///< whole pad, per axis [N s/m]
  double clip_preload = 0.0;     ///< whole pad, along axis 3 [N]
  bool tension_cutoff = false;   ///< along axis 3

  int n_cells() const { return cells[0] * cells[1]; }
  /// Centre of cell `index` (axis 1 runs fastest), global frame [m].
  Eigen::Vector3d cell_point(int index) const;
  /// Share of the pad's area that a cell has; the weights of a seat sum to one.
  double cell_weight() const { return 1.0 / n_cells(); }
  /// Law of component `axis` (0, 1, 2) of one cell: the pad's divided by the number of cells.
  PadLaw cell_law(int axis) const;
};

/// Reads every `[[rail_seat]]`. Throws a config error for: no seat, a repeated name, axes that are not orthonormal to
/// 1e-9 or left-handed, cells < 1, half-lengths <= 0, negative stiffness, damping or preload.
std::vector<RailSeat> read_rail_seats(const CaseFile& file);

/// Number of interface values of one vector field: 3 components x the cells of all seats, in order of seat, cell, axis.
std::size_t n_interface_values(const std::vector<RailSeat>& seats);

/// Laws of all interface values, in the order of the fields.
std::vector<PadLaw> interface_laws(const std::vector<RailSeat>& seats);

}  // namespace proto
