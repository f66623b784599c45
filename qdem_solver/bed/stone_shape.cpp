#include "qdem_solver/bed/stone_shape.hpp"

#include <gmsh.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "proto/error.hpp"
#include "qdem_solver/bed/random.hpp"
#include "qdem_solver/engine/stability.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

/// Gmsh keeps one global session; this one is silent and serial, so that a mesh depends on its input alone. Gmsh sets
/// the program's number of OpenMP threads; the destructor puts it back.
class GmshSession {
 public:
  GmshSession() : n_threads_(omp_get_max_threads()) {
    gmsh::initialize();
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::option::setNumber("Mesh.RandomSeed", 1);
    gmsh::option::setNumber("Mesh.Optimize", 1);
    gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 1);
  }
  ~GmshSession() {
    gmsh::finalize();
    omp_set_num_threads(n_threads_);
  }
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

 private:
  int n_threads_;
};

void add_geometry(const Polyhedron& shape, double size) {
  for (std::size_t i = 0; i < shape.corners.size(); ++i) {
    const Vector3d& x = shape.corners[i];
    gmsh::model::geo::addPoint(x[0], x[1], x[2], size, static_cast<int>(i) + 1);
  }
  std::map<std::pair<int, int>, int> lines;
  std::vector<int> surfaces;
  for (const auto& face : shape.faces) {
    std::vector<int> loop;
    for (int k = 0; k < 3; ++k) {
      const int p = face[k], q = face[(k + 1) % 3];
      auto& line = lines[{std::min(p, q), std::max(p, q)}];
      if (line == 0) line = gmsh::model::geo::addLine(std::min(p, q) + 1, std::max(p, q) + 1);
      loop.push_back(p < q ? line : -line);
    }
    surfaces.push_back(gmsh::model::geo::addPlaneSurface({gmsh::model::geo::addCurveLoop(loop)}));
  }
  gmsh::model::geo::addVolume({gmsh::model::geo::addSurfaceLoop(surfaces)});
  gmsh::model::geo::synchronize();
}

Template take_mesh(const std::string& name) {
  std::vector<std::size_t> tags, tet_tags, tet_nodes;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  gmsh::model::mesh::getElementsByType(4, tet_tags, tet_nodes);
  std::map<std::size_t, Vector3d> places;
  for (std::size_t i = 0; i < tags.size(); ++i) places[tags[i]] = Vector3d(&coordinates[3 * i]);
  std::map<std::size_t, int> numbers;
  for (const std::size_t tag : tet_nodes) numbers[tag] = 0;
  std::vector<Vector3d> nodes;
  for (auto& [tag, number] : numbers) number = static_cast<int>(nodes.size()), nodes.push_back(places.at(tag));
  std::vector<std::array<int, 4>> tets;
  for (std::size_t e = 0; e < tet_tags.size(); ++e) {
    std::array<int, 4> tet;
    for (int k = 0; k < 4; ++k) tet[k] = numbers.at(tet_nodes[4 * e + k]);
    const Vector3d &a = nodes[tet[0]], &b = nodes[tet[1]], &c = nodes[tet[2]], &d = nodes[tet[3]];
    if ((b - a).cross(c - a).dot(d - a) < 0) std::swap(tet[2], tet[3]);
    tets.push_back(tet);
  }
  return make_template(name, std::move(nodes), std::move(tets));
}

/// A template of the wanted size, or none. `step` is the largest stable step for a rock of unit wave speed [m].
struct Candidate {
  Template shape;
  double step = 0.0;
  std::string refusal;
};

double step_of_unit_rock(const Template& shape) {
  Material unit;
  unit.young = 1, unit.poisson = 0.25, unit.density = 1;
  return largest_stable_step(template_rates(shape, unit));
}

/// Share of the stone's mass that its lightest surface node carries.
double lightest_corner(const Template& shape) {
  double least = shape.volume();
  for (const int node : shape.surface_nodes) least = std::min(least, shape.node_volumes[node]);
  return least / shape.volume();
}

Candidate best_mesh(const std::string& name, const Polyhedron& stone, const StoneShapes& wanted) {
  Candidate best;
  int least_seen = 1 << 30, most_seen = 0;
  int n_good = 0;
  for (const double size : {0.62, 0.56, 0.51, 0.47, 0.43, 0.40, 0.37}) {
    if (n_good == 3) break;  // finer meshes have smaller steps
    try {
      Template shape = mesh_polyhedron(name, stone, size);
      least_seen = std::min(least_seen, shape.n_tets()), most_seen = std::max(most_seen, shape.n_tets());
      if (shape.n_tets() < wanted.least_tets || shape.n_tets() > wanted.most_tets) continue;
      if (lightest_corner(shape) < 0.005) continue;  // its contact would rule the step
      ++n_good;
      const double step = step_of_unit_rock(shape);
      if (step > best.step) best.step = step, best.shape = std::move(shape);
    } catch (const proto::Error& error) {
      best.refusal = error.what();  // the mesher failed at this size; the next may do
    }
  }
  if (best.step > 0) {
    best.refusal.clear();
  } else if (best.refusal.empty()) {
    best.refusal =
        std::to_string(least_seen) + " to " + std::to_string(most_seen) + " tetrahedra, or a corner too light";
  }
  return best;
}

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

Template mesh_polyhedron(const std::string& name, const Polyhedron& shape, double size) {
  const GmshSession session;
  try {
    add_geometry(shape, size);
    gmsh::model::mesh::generate(3);
  } catch (const std::exception& error) {
    throw proto::Error(proto::ExitCode::bad_data, std::string("Gmsh cannot mesh the stone: ") + error.what(),
                       "template " + name);
  } catch (int) {  // what Gmsh 4.8 throws
    throw proto::Error(proto::ExitCode::bad_data, "Gmsh cannot mesh the stone", "template " + name);
  }
  return take_mesh(name);
}

StoneTemplates make_stone_templates(const StoneShapes& wanted) {
  StoneTemplates result;
  std::vector<Candidate> candidates;
  const int n_candidates = 3 * wanted.n_templates + 4;
  for (int i = 0; i < n_candidates; ++i) {
    Random random(wanted.seed, 500 + i);
    const double elongation = random.uniform(wanted.elongation.lowest, wanted.elongation.highest);
    const double flatness = random.uniform(wanted.flatness.lowest, wanted.flatness.highest);
    const std::string name = "stone_" + std::to_string(i);
    candidates.push_back(best_mesh(name, random_stone(elongation, flatness, wanted.seed, i), wanted));
    candidates.back().shape.name = name;
  }
  std::vector<double> steps;
  for (const Candidate& c : candidates) {
    if (c.step > 0) steps.push_back(c.step);
  }
  if (steps.empty()) {
    throw proto::Error(proto::ExitCode::bad_data, "no stone template could be meshed", "[bed] elements_per_stone",
                       "widen the range");
  }
  std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
  const double median = steps[steps.size() / 2];
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

}  // namespace qdem::bed
