#include "coupler/page/surface.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>

namespace coupler::page {
namespace {

using study::Mesh;

constexpr std::uint32_t no_corner = std::numeric_limits<std::uint32_t>::max();

/// A face of a cell; a triangle has no fourth corner.
struct Face {
  explicit Face(std::array<std::uint32_t, 4> round) : corners(round), key(round) { std::sort(key.begin(), key.end()); }

  std::array<std::uint32_t, 4> corners;
  std::array<std::uint32_t, 4> key;
};

using LocalFace = std::array<int, 4>;
const std::vector<LocalFace> tetrahedron_faces = {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}};
const std::vector<LocalFace> hexahedron_faces = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                 {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

const std::vector<LocalFace>& faces_of(std::uint8_t type) {
  static const std::vector<LocalFace> none;
  return type == 10 ? tetrahedron_faces : type == 12 ? hexahedron_faces : none;
}

/// The faces of the cells that have no partner.
std::vector<Face> outer_faces(const Mesh& mesh, const std::vector<std::size_t>& cells) {
  std::vector<Face> faces;
  for (const auto cell : cells) {
    for (const auto& local : faces_of(mesh.types[cell])) {
      std::array<std::uint32_t, 4> corners{};
      for (std::size_t k = 0; k < 4; ++k) {
        const auto corner = mesh.offsets[cell] + static_cast<std::size_t>(local[k]);
        corners[k] = local[k] < 0 ? no_corner : mesh.corners[corner];
      }
      faces.emplace_back(corners);
    }
  }
  std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.key < b.key; });
  std::vector<Face> outer;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].key == faces[i].key) ++end;
    if (end == i + 1) outer.push_back(faces[i]);
    i = end;
  }
  return outer;
}

}  // namespace

Surface surface_of(const Mesh& mesh) {
  std::map<std::pair<bool, std::int64_t>, std::vector<std::size_t>> cells_of;  // (no sleeper, number)
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    cells_of[{!mesh.sleeper[cell], mesh.bodies[cell]}].push_back(cell);
  }
  Surface surface;
  for (const auto& [key, cells] : cells_of) {
    Surface::Body body;
    body.number = key.second, body.sleeper = !key.first;
    body.first_point = surface.points.size(), body.first_triangle = surface.triangles.size() / 3;
    std::unordered_map<std::uint32_t, std::uint32_t> new_number;
    const auto point = [&](std::uint32_t old) {
      const auto [place, is_new] = new_number.try_emplace(old, static_cast<std::uint32_t>(surface.points.size()));
      if (is_new) surface.points.push_back(old);
      return place->second;
    };
    for (const auto& face : outer_faces(mesh, cells)) {
      const auto& c = face.corners;
      for (const auto corner : {c[0], c[1], c[2]}) surface.triangles.push_back(point(corner));
      if (c[3] == no_corner) continue;
      for (const auto corner : {c[0], c[2], c[3]}) surface.triangles.push_back(point(corner));
    }
    body.n_points = surface.points.size() - body.first_point;
    body.n_triangles = surface.triangles.size() / 3 - body.first_triangle;
    if (body.n_triangles > 0) surface.bodies.push_back(body);
  }
  return surface;
}

}  // namespace coupler::page
