#include "qdem_solver/bed/scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "proto/error.hpp"
#include "qdem_solver/bed/surface_algorithms.hpp"
#include "qdem_solver/bed/surface_file.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

constexpr double merging_share = 1e-6;  // of the stone's extent

[[noreturn]] void refuse(const std::string& problem, const std::string& path, const std::string& advice) {
  throw proto::Error(proto::ExitCode::bad_data, problem, path, advice);
}

std::string in_words(const Vector3d& x) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

double extent(const Polyhedron& shape) {
  Vector3d low = shape.corners[0], high = low;
  for (const Vector3d& x : shape.corners) low = low.cwiseMin(x), high = high.cwiseMax(x);
  return (high - low).norm();
}

/// Of every corner the number of the one it becomes.
std::vector<int> nearby_corners(const std::vector<Vector3d>& corners, double tolerance) {
  std::vector<int> order(corners.size()), becomes(corners.size());
  std::iota(order.begin(), order.end(), 0);
  becomes = order;
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return corners[i][0] < corners[j][0]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Vector3d& x = corners[order[i]];
    for (std::size_t j = i; j-- > 0 && x[0] - corners[order[j]][0] <= tolerance;) {
      if ((x - corners[order[j]]).norm() > tolerance) continue;
      becomes[order[i]] = becomes[order[j]];
      break;
    }
  }
  return becomes;
}

void drop_unused_corners(Polyhedron& shape) {
  std::vector<int> number(shape.corners.size(), -1);
  std::vector<Vector3d> kept;
  for (auto& face : shape.faces) {
    for (int& corner : face) {
      if (number[corner] < 0) number[corner] = static_cast<int>(kept.size()), kept.push_back(shape.corners[corner]);
      corner = number[corner];
    }
  }
  shape.corners = std::move(kept);
}

/// What a step of the repair did, for the notes.
void note(Scan& scan, std::size_t n, const std::string& what) {
  if (n > 0) scan.repairs.push_back(std::to_string(n) + " " + what);
}

void merge_corners(Scan& scan) {
  Polyhedron& shape = scan.shape;
  const auto becomes = nearby_corners(shape.corners, merging_share * extent(shape));
  std::size_t n_merged = 0;
  for (std::size_t i = 0; i < becomes.size(); ++i) n_merged += becomes[i] != static_cast<int>(i);
  for (auto& face : shape.faces) {
    for (int& corner : face) corner = becomes[corner];
  }
  note(scan, n_merged, "duplicate vertices merged");
}

void drop_facets(Scan& scan) {
  std::set<std::array<int, 3>> seen;
  std::vector<std::array<int, 3>> kept;
  std::size_t n_degenerate = 0, n_doubled = 0;
  for (const auto& face : scan.shape.faces) {
    auto key = face;
    std::sort(key.begin(), key.end());
    const bool degenerate = key[0] == key[1] || key[1] == key[2];
    const bool doubled = !degenerate && !seen.insert(key).second;
    n_degenerate += degenerate, n_doubled += doubled;
    if (!degenerate && !doubled) kept.push_back(face);
  }
  scan.shape.faces = std::move(kept);
  drop_unused_corners(scan.shape);
  note(scan, n_degenerate, "degenerate facets dropped");
  note(scan, n_doubled, "doubled facets dropped");
}

/// How often facets run along an edge from its lower to its higher corner, and back.
struct EdgeUse {
  int forward = 0, backward = 0;
};
using Edges = std::map<std::pair<int, int>, EdgeUse>;

Edges edges_of(const Polyhedron& shape) {
  Edges edges;
  for (const auto& face : shape.faces) {
    for (int k = 0; k < 3; ++k) {
      const int a = face[k], b = face[(k + 1) % 3];
      EdgeUse& use = edges[std::minmax(a, b)];
      (a < b ? use.forward : use.backward) += 1;
    }
  }
  return edges;
}

void check_edges(const Polyhedron& shape, const Edges& edges, const std::string& path) {
  const std::pair<const std::pair<int, int>, EdgeUse>*open = nullptr, *crowded = nullptr;
  std::size_t n_open = 0;
  for (const auto& edge : edges) {
    const int n = edge.second.forward + edge.second.backward;
    if (n == 1 && n_open++ == 0) open = &edge;
    if (n > 2 && crowded == nullptr) crowded = &edge;
  }
  const auto ends = [&](const auto& edge) {
    return "from " + in_words(shape.corners[edge.first.first]) + " to " + in_words(shape.corners[edge.first.second]);
  };
  if (crowded != nullptr) {
    refuse("the surface is not simple: " + std::to_string(crowded->second.forward + crowded->second.backward) +
               " facets share the edge " + ends(*crowded),
           path, "take inner walls and stray facets away in the scanner's program");
  }
  if (open == nullptr) return;
  refuse("the surface is open: " + std::to_string(n_open) + " edges belong to one facet only, the first " + ends(*open),
         path, "close its holes in the scanner's program");
}

void turn_facets(Scan& scan, const Edges& edges, const std::string& path) {
  const bool agree = std::all_of(edges.begin(), edges.end(), [](const auto& edge) { return edge.second.forward == 1; });
  const auto before = scan.shape.faces;
  if (!make_consistent(scan.shape)) {
    refuse("the surface is one-sided, or parts of it touch in a corner", path, "export the outer surface only");
  }
  if (agree) return;
  std::size_t n_turned = 0;
  for (std::size_t f = 0; f < before.size(); ++f) n_turned += before[f] != scan.shape.faces[f];
  note(scan, std::min(n_turned, before.size() - n_turned), "facets turned to the side of their neighbours");
}

void turn_outward(Scan& scan) {
  if (volume(scan.shape) > 0) return;
  for (auto& face : scan.shape.faces) std::swap(face[1], face[2]);
  scan.repairs.emplace_back("turned, it was inside out");
}

void drop_flat_facets(Scan& scan, const std::string& path) {
  const auto n_removed = remove_flat_facets(scan.shape);
  if (!n_removed) refuse("facets without area cannot be taken away", path, "mesh the surface anew");
  note(scan, static_cast<std::size_t>(*n_removed), "degenerate facets dropped");
}

void check_body(const Polyhedron& shape, const std::string& path) {
  if (const int n_parts = count_parts(shape); n_parts > 1) {
    refuse("the surface has " + std::to_string(n_parts) + " parts", path, "a file holds one stone without hollows");
  }
  if (const auto place = self_crossing(shape)) {
    refuse("the surface cuts through itself, first at " + in_words(*place), path,
           "smooth or mesh it anew in the scanner's program");
  }
  if (!(volume(shape) > 1e-4 * std::pow(extent(shape), 3))) {
    refuse("the surface encloses hardly any volume", path, "a stone is a body, not a sheet");
  }
}

}  // namespace

Scan read_scan(const std::string& path) {
  Scan scan{read_surface(path), {}};
  merge_corners(scan);
  drop_facets(scan);
  if (scan.shape.faces.empty()) refuse("no facet of the surface has an area", path, "export it again");
  const Edges edges = edges_of(scan.shape);
  check_edges(scan.shape, edges, path);
  turn_facets(scan, edges, path);
  drop_flat_facets(scan, path);
  turn_outward(scan);
  check_body(scan.shape, path);
  return scan;
}

}  // namespace qdem::bed
