#include "qdem_solver/bed/stone_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "proto/error.hpp"
#include "qdem_solver/bed/random.hpp"
#include "qdem_solver/bed/stone_files.hpp"
#include "qdem_solver/bed/stone_mesh.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> spread_directions(int n, double least_angle, Random& random) {
  std::vector<Vector3d> directions;
  for (int tries = 0; static_cast<int>(directions.size()) < n && tries < 2000; ++tries) {
    const Vector3d candidate = random.direction();
    const bool clear = std::all_of(directions.begin(), directions.end(),
                                   [&](const Vector3d& other) { return other.dot(candidate) < std::cos(least_angle); });
    if (clear) directions.push_back(candidate);
  }
  return directions;
}

}  // namespace

Polyhedron convex_hull(const std::vector<Vector3d>& points) {
  Polyhedron hull;
  std::vector<std::array<int, 3>> faces;
  const int n = static_cast<int>(points.size());
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        const Vector3d normal = (points[j] - points[i]).cross(points[k] - points[i]);
        int above = 0, below = 0;
        for (int l = 0; l < n; ++l) {
          if (l == i || l == j || l == k) continue;
          (normal.dot(points[l] - points[i]) > 0 ? above : below) += 1;
        }
        if (above == 0) faces.push_back({i, j, k});
        if (below == 0) faces.push_back({i, k, j});
      }
    }
  }
  std::map<int, int> numbers;
  for (const auto& face : faces) {
    for (const int corner : face) numbers[corner] = 0;
  }
  for (auto& [point, number] : numbers) {
    number = static_cast<int>(hull.corners.size());
    hull.corners.push_back(points[point]);
  }
  for (const auto& face : faces) hull.faces.push_back({numbers[face[0]], numbers[face[1]], numbers[face[2]]});
  return hull;
}

Polyhedron random_stone(double elongation, double flatness, std::uint64_t seed, std::uint64_t number) {
  Random random(seed, 1000 + number);
  const int n_points = 12 + static_cast<int>(random.index(5));
  std::vector<Vector3d> points;
  for (const Vector3d& direction : spread_directions(n_points, M_PI / 6, random)) {
    points.push_back(random.uniform(0.85, 1.1) * direction);
  }
  const Vector3d extents(elongation, 1.0, flatness);
  for (Vector3d& p : points) p = p.cwiseProduct(extents);
  Polyhedron hull = convex_hull(points);
  Vector3d low = hull.corners[0], high = hull.corners[0];
  for (const Vector3d& p : hull.corners) low = low.cwiseMin(p), high = high.cwiseMax(p);
  for (Vector3d& p : hull.corners) p = (p - 0.5 * (low + high)).cwiseProduct(extents.cwiseQuotient(high - low));
  return hull;
}

namespace {

/// Of every random stone the mesh between least_tets and most_tets with the largest stable step; stones without one, or
/// with a step below 0.75 of the median, are refused and reported.
StoneTemplates generate(const StoneShapes& wanted) {
  StoneTemplates result;
  std::vector<Candidate> candidates;
  const MeshWish wish{wanted.least_tets, wanted.most_tets, {0.62, 0.56, 0.51, 0.47, 0.43, 0.40, 0.37}, 0.005};
  const int n_candidates = 3 * wanted.n_templates + 4;
  for (int i = 0; i < n_candidates; ++i) {
    Random random(wanted.seed, 500 + i);
    const double elongation = random.uniform(wanted.elongation.lowest, wanted.elongation.highest);
    const double flatness = random.uniform(wanted.flatness.lowest, wanted.flatness.highest);
    const std::string name = "stone_" + std::to_string(i);
    candidates.push_back(best_mesh(name, random_stone(elongation, flatness, wanted.seed, i), wish));
  }
  const double median = median_step(candidates);
  if (!(median > 0)) {
    throw proto::Error(proto::ExitCode::bad_data, "no stone template could be meshed", "[bed] elements_per_stone",
                       "widen the range");
  }
  for (Candidate& c : candidates) {
    if (c.step > 0 && c.step < 0.75 * median) {
      char text[64];
      std::snprintf(text, sizeof text, "stable step %.2f of the median", c.step / median);
      c.refusal = text;
    }
    if (!c.refusal.empty()) {
      result.notes.push_back("template " + c.shape.name + " refused: " + c.refusal);
    } else if (static_cast<int>(result.templates.size()) < wanted.n_templates) {
      result.templates.push_back(std::move(c.shape));
    }
  }
  if (static_cast<int>(result.templates.size()) < wanted.n_templates) {
    throw proto::Error(proto::ExitCode::bad_data,
                       "only " + std::to_string(result.templates.size()) + " of " + std::to_string(wanted.n_templates) +
                           " stone templates have a mesh of the wanted size",
                       "[bed] elements_per_stone", "widen the range or lower [bed] templates");
  }
  return result;
}

}  // namespace

StoneTemplates make_stone_templates(const StoneShapes& wanted) {
  return wanted.files.empty() ? generate(wanted) : read_stone_templates(wanted);
}

}  // namespace qdem::bed
