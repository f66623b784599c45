// The outside of the bodies of a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "coupler/study/mesh.hpp"

namespace coupler::page {

/// Faces that belong to one cell of their body only, as triangles. Sleepers come first, then by number; the points and
/// triangles of a body are one range.
struct Surface {
  struct Body {
    std::int64_t number = 0;
    bool sleeper = false;
    std::size_t first_point = 0, n_points = 0;
    std::size_t first_triangle = 0, n_triangles = 0;
  };
  std::vector<Body> bodies;
  std::vector<std::uint32_t> points;     ///< of the mesh; once for every body that has it
  std::vector<std::uint32_t> triangles;  ///< [n][3] into `points`
};
Surface surface_of(const study::Mesh& mesh);

}  // namespace coupler::page
