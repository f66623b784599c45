#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>

#include "proto/error.hpp"
#include "qdem_solver/model/adjacency.hpp"
#include "qdem_solver/model/model.hpp"

namespace qdem {
namespace {

using proto::Error;
using proto::ExitCode;

/// Below this share of the cube of the longest edge a tetrahedron counts as flat.
constexpr double flat_share = 1e-5;

Eigen::Matrix3d edge_matrix(const Template& shape, const std::array<int, 4>& tet) {
  Eigen::Matrix3d dm;
  for (int k = 0; k < 3; ++k) dm.col(k) = shape.nodes[tet[k + 1]] - shape.nodes[tet[0]];
  return dm;
}

double longest_edge(const Template& shape, const std::array<int, 4>& tet) {
  double longest = 0.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) longest = std::max(longest, (shape.nodes[tet[i]] - shape.nodes[tet[j]]).norm());
  }
  return longest;
}

void check_node_numbers(const Template& shape) {
  for (std::size_t e = 0; e < shape.tets.size(); ++e) {
    for (const int node : shape.tets[e]) {
      if (node >= 0 && node < shape.n_nodes()) continue;
      throw Error(ExitCode::bad_data,
                  "tetrahedron " + std::to_string(e) + " names node " + std::to_string(node) + " of " +
                      std::to_string(shape.n_nodes()),
                  "template " + shape.name);
    }
  }
}

void refuse_bad_tets(const Template& shape, const TetLabels& labels) {
  std::ostringstream list;
  int n_bad = 0;
  for (int e = 0; e < shape.n_tets(); ++e) {
    if (shape.volumes[e] > flat_share * std::pow(longest_edge(shape, shape.tets[e]), 3)) continue;
    if (++n_bad > 10) continue;
    list << (n_bad > 1 ? ", " : "") << (labels.tags.empty() ? e : labels.tags[e]) << " (volume " << shape.volumes[e]
         << " " << labels.volume_unit << ")";
  }
  if (n_bad == 0) return;
  if (n_bad > 10) list << " and " << n_bad - 10 << " more";
  throw Error(ExitCode::bad_data, std::to_string(n_bad) + " inverted or flat tetrahedra: " + list.str(),
              "template " + shape.name, "mesh it again, or order each tetrahedron's nodes to a positive volume");
}

void add_gradients_and_volumes(Template& shape) {
  shape.node_volumes.assign(shape.nodes.size(), 0.0);
  for (const auto& tet : shape.tets) {
    const Eigen::Matrix3d dm = edge_matrix(shape, tet);
    const double volume = dm.determinant() / 6;
    const Eigen::Matrix3d inverse = dm.inverse();
    std::array<double, 9> gradients;
    for (int i = 0; i < 9; ++i) gradients[i] = inverse(i / 3, i % 3);
    shape.gradients.push_back(gradients);
    shape.volumes.push_back(volume);
    for (const int node : tet) shape.node_volumes[node] += volume / 4;
  }
}

/// Faces of a positively oriented tetrahedron, outward by the right-hand rule.
constexpr int faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

void add_skin(Template& shape) {
  std::map<std::array<int, 3>, std::pair<int, Triangle>> seen;
  for (const auto& tet : shape.tets) {
    for (const auto& face : faces) {
      const Triangle triangle{{tet[face[0]], tet[face[1]], tet[face[2]]}};
      std::array<int, 3> key = triangle.nodes;
      std::sort(key.begin(), key.end());
      auto& entry = seen[key];
      ++entry.first, entry.second = triangle;
    }
  }
  std::vector<char> on_surface(shape.nodes.size(), 0);
  for (const auto& [key, entry] : seen) {
    if (entry.first != 1) continue;
    shape.triangles.push_back(entry.second);
    for (const int node : key) on_surface[node] = 1;
  }
  for (int i = 0; i < shape.n_nodes(); ++i) {
    if (on_surface[i]) shape.surface_nodes.push_back(i);
  }
}

Eigen::Vector3d unit_normal(const Template& shape, const Triangle& triangle) {
  const auto& n = triangle.nodes;
  return (shape.nodes[n[1]] - shape.nodes[n[0]]).cross(shape.nodes[n[2]] - shape.nodes[n[0]]).normalized();
}

bool is_sharp(const Template& shape, const Edge& edge, double sharp_angle_deg) {
  const Triangle &a = shape.triangles[edge.triangles[0]], &b = shape.triangles[edge.triangles[1]];
  const Eigen::Vector3d normal_a = unit_normal(shape, a), normal_b = unit_normal(shape, b);
  const double angle = std::atan2(normal_a.cross(normal_b).norm(), normal_a.dot(normal_b));
  if (angle < sharp_angle_deg * M_PI / 180) return false;
  for (const int node : b.nodes) {
    if (node == edge.nodes[0] || node == edge.nodes[1]) continue;
    return normal_a.dot(shape.nodes[node] - shape.nodes[edge.nodes[0]]) < 0;  // a hollow edge cannot touch another
  }
  return false;
}

std::string in_words(const Eigen::Vector3d& x) {
  std::ostringstream text;
  text << "(" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return text.str();
}

void add_edges(Template& shape, double sharp_angle_deg) {
  std::map<std::array<int, 2>, std::vector<int>> owners;
  for (int t = 0; t < static_cast<int>(shape.triangles.size()); ++t) {
    const auto& n = shape.triangles[t].nodes;
    for (int k = 0; k < 3; ++k) owners[{std::min(n[k], n[(k + 1) % 3]), std::max(n[k], n[(k + 1) % 3])}].push_back(t);
  }
  for (const auto& [nodes, triangles] : owners) {
    if (triangles.size() != 2) {
      throw Error(ExitCode::bad_data,
                  "the surface is not closed and simple: " + std::to_string(triangles.size()) +
                      " triangles share the edge of nodes " + std::to_string(nodes[0]) + " and " +
                      std::to_string(nodes[1]) + ", " + in_words(shape.nodes[nodes[0]]) + " to " +
                      in_words(shape.nodes[nodes[1]]),
                  "template " + shape.name, "parts of a body must share whole faces");
    }
    Edge edge{nodes, {triangles[0], triangles[1]}, false};
    edge.sharp = is_sharp(shape, edge, sharp_angle_deg);
    shape.edges.push_back(edge);
  }
}

void add_adjacency(Template& shape) {
  Adjacency adjacency = make_adjacency(shape.n_nodes(), shape.tets);
  for (int i = 0; i < shape.n_nodes(); ++i) {
    if (adjacency.offsets[i] < adjacency.offsets[i + 1]) continue;
    throw Error(ExitCode::bad_data, "node " + std::to_string(i) + " belongs to no tetrahedron",
                "template " + shape.name);
  }
  shape.adjacency_offsets = std::move(adjacency.offsets), shape.adjacency_slots = std::move(adjacency.slots);
}

}  // namespace

Template make_template(std::string name, std::vector<Eigen::Vector3d> nodes, std::vector<std::array<int, 4>> tets,
                       double sharp_angle_deg, const TetLabels& labels) {
  Template shape;
  shape.name = std::move(name), shape.nodes = std::move(nodes), shape.tets = std::move(tets);
  check_node_numbers(shape);
  add_gradients_and_volumes(shape);
  shape.whole_volume = std::accumulate(shape.volumes.begin(), shape.volumes.end(), 0.0);
  refuse_bad_tets(shape, labels);
  add_skin(shape);
  add_edges(shape, sharp_angle_deg);
  add_adjacency(shape);
  return shape;
}

}  // namespace qdem
