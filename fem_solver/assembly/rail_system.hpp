// The track with a rail of solid elements.
#pragma once

#include <memory>
#include <vector>

#include "fem_solver/assembly/rail_mesh.hpp"
#include "fem_solver/assembly/track_system.hpp"

namespace fem {

/// Matrices of the track, and the mesh whose degrees of freedom come first.
struct RailSystem : TrackSystem {
  std::unique_ptr<RailMesh> mesh;
  double element_length = 0.0;  ///< of the refined part [m]
  double fine_begin = 0.0;      ///< where it begins [m]
  double fine_end = 0.0;        ///< and ends [m]
  int planes_per_bay = 0;       ///< elements along x in one bay
};

/// Builds the track of a case; see assemble_track(), check_seats() and rail_planes(). The mass is lumped.
RailSystem build_rail_system(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner);

}  // namespace fem
