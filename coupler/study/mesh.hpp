// The mesh of a result file.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/result/reader.hpp"

namespace coupler::study {

/// Cells of /VTKHDF with the body that each belongs to.
struct Mesh {
  std::vector<double> points;  ///< [n][3] at the start [m]
  std::vector<std::uint32_t> corners;
  std::vector<std::uint32_t> offsets;  ///< [cells + 1] into `corners`
  std::vector<std::uint8_t> types;     ///< of VTK: 10 tetrahedron, 12 hexahedron; other cells have no faces here
  std::vector<std::int64_t> bodies;    ///< [cells]; 0 where the file names no bodies
  std::vector<bool> sleeper;           ///< [cells]
  std::vector<bool> ground;            ///< [cells] of a layer of it

  bool is_stone(std::size_t cell) const { return !sleeper[cell] && !ground[cell]; }  ///< of qdem.h5
  std::size_t n_cells() const { return types.size(); }
  std::size_t n_points() const { return points.size() / 3; }
};

/// Throws proto::Error (bad_data) where the file has no mesh, or one with an index out of range.
Mesh read_mesh(const proto::ResultReader& file);

}  // namespace coupler::study
