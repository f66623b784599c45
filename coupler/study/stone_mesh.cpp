#include "coupler/study/stone_mesh.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "coupler/study/mesh.hpp"
#include "proto/error.hpp"

namespace coupler::study {
namespace {

using Eigen::Vector3d;

constexpr int tetrahedron = 10;  // of VTK

Mesh read_stones(const proto::ResultReader& qdem) {
  auto mesh = read_mesh(qdem);
  for (const auto type : mesh.types) {
    if (type == tetrahedron) continue;
    throw proto::Error(proto::ExitCode::bad_data, "stones that are not of tetrahedra", "/VTKHDF/Types");
  }
  return mesh;
}

std::size_t corner(const Mesh& mesh, std::size_t cell, std::size_t k) {
  return mesh.corners[mesh.offsets[cell] + k];
}

Vector3d point(const Mesh& mesh, std::size_t cell, std::size_t k) {
  return Eigen::Map<const Vector3d>(&mesh.points[3 * corner(mesh, cell, k)]);
}

double volume_of(const Mesh& mesh, std::size_t cell) {
  const Vector3d a = point(mesh, cell, 0);
  const Vector3d p = point(mesh, cell, 1) - a, q = point(mesh, cell, 2) - a, r = point(mesh, cell, 3) - a;
  return p.cross(q).dot(r) / 6;
}

}  // namespace

std::optional<analysis::Footprint> sleeper_box(const proto::ResultReader& qdem) {
  const Mesh mesh = read_stones(qdem);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vector3d low = Vector3d::Constant(infinity), high = -low;
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    if (!mesh.sleeper[cell]) continue;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vector3d x = point(mesh, cell, k);
      low = low.cwiseMin(x), high = high.cwiseMax(x);
    }
  }
  if (!(low[0] < high[0])) return std::nullopt;
  return analysis::Footprint{low[0], high[0], low[1], high[1], low[2]};
}

StoneMesh::StoneMesh(const proto::ResultReader& qdem) {
  const Mesh mesh = read_stones(qdem);
  std::map<std::int64_t, std::int64_t> numbers;  // of a body among the stones
  in_stone_.resize(mesh.n_cells());
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    in_stone_[cell] = mesh.is_stone(cell);
    if (in_stone_[cell]) numbers[mesh.bodies[cell]] = 0;
  }
  std::int64_t next = 0;
  for (auto& number : numbers) number.second = next++;
  stone_of_.assign(mesh.n_points(), -1);
  share_.assign(stone_of_.size(), 0.0);
  std::vector<double> volume(numbers.size(), 0.0);
  std::size_t n_cells = 0;
  for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell) {
    if (!in_stone_[cell]) continue;
    const auto stone = numbers[mesh.bodies[cell]];
    const double v = volume_of(mesh, cell);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t i = corner(mesh, cell, k);
      stone_of_[i] = stone, share_[i] += v / 4;
    }
    volume[static_cast<std::size_t>(stone)] += v;
    element_size_ += std::cbrt(6 * std::sqrt(2.0) * v);
    ++n_cells;
  }
  if (n_cells > 0) element_size_ /= static_cast<double>(n_cells);
  for (std::size_t i = 0; i < share_.size(); ++i) {
    if (stone_of_[i] >= 0) share_[i] /= volume[static_cast<std::size_t>(stone_of_[i])];
  }
  places_.resize(numbers.size());
  const auto mean = centres(mesh.points);
  for (std::size_t i = 0; i < mean.size(); ++i) places_[i / 3][i % 3] = mean[i];
}

std::vector<double> StoneMesh::centres(const std::vector<double>& values) const {
  std::vector<double> result(3 * n_stones(), 0.0);
  for (std::size_t i = 0; i < stone_of_.size(); ++i) {
    if (stone_of_[i] < 0) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      result[3 * static_cast<std::size_t>(stone_of_[i]) + c] += share_[i] * values[3 * i + c];
    }
  }
  return result;
}

std::vector<double> StoneMesh::displacement(const proto::ResultReader& qdem, std::uint64_t step) const {
  const std::uint64_t n = stone_of_.size();
  return centres(qdem.read_rows("/VTKHDF/PointData/displacement", step * n, n).values);
}

double StoneMesh::largest_stress(const proto::ResultReader& qdem, std::uint64_t step) const {
  const std::uint64_t n = in_stone_.size();
  const auto stress = qdem.read_rows("/VTKHDF/CellData/von_mises_stress", step * n, n).values;
  double largest = 0.0;
  for (std::size_t cell = 0; cell < n; ++cell) {
    if (in_stone_[cell]) largest = std::max(largest, stress[cell]);
  }
  return largest;
}

}  // namespace coupler::study
