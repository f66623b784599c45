#include "qdem_solver/contact/sphere_radii.hpp"

#include <algorithm>
#include <map>

namespace qdem {
namespace {

constexpr int samples = 12;  // along an edge of a triangle

/// Of the surface edges at each node the longest, at scale 1; 0 inside [m].
std::vector<double> longest_edges(const Template& shape) {
  std::vector<double> longest(shape.nodes.size(), 0.0);
  for (const Edge& edge : shape.edges) {
    const double length = (shape.nodes[edge.nodes[1]] - shape.nodes[edge.nodes[0]]).norm();
    for (const int node : edge.nodes) longest[node] = std::max(longest[node], length);
  }
  return longest;
}

bool is_open(const Template& shape, double scale, const std::vector<double>& radii, const Triangle& triangle) {
  for (int i = 0; i <= samples; ++i) {
    for (int j = 0; i + j <= samples; ++j) {
      const double weights[3] = {static_cast<double>(i) / samples, static_cast<double>(j) / samples,
                                 static_cast<double>(samples - i - j) / samples};
      Eigen::Vector3d point = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) point += weights[k] * shape.nodes[triangle.nodes[k]];
      const bool covered = std::any_of(triangle.nodes.begin(), triangle.nodes.end(), [&](int node) {
        return scale * (point - shape.nodes[node]).norm() <= radii[node];
      });
      if (!covered) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<double> sphere_radii(const ContactLaw& law, const Template& shape) {
  std::vector<double> radii(shape.nodes.size(), 0.0);
  if (law.radii == SphereRadii::equal) {
    for (const int node : shape.surface_nodes) radii[node] = law.rounding;
    return radii;
  }
  const std::vector<double> longest = longest_edges(shape);
  double sum = 0.0;
  for (const double length : longest) sum += length;
  const double mean = sum / static_cast<double>(shape.surface_nodes.size());
  for (const int node : shape.surface_nodes) radii[node] = law.rounding * longest[node] / mean;
  return radii;
}

double open_facets(const Model& model) {
  std::map<int, std::vector<double>> radii;
  double open = 0.0, all = 0.0;
  for (const Body& body : model.bodies) {
    const Template& shape = model.templates[body.template_id];
    const auto [found, is_new] = radii.try_emplace(body.template_id);
    if (is_new) found->second = sphere_radii(model.contact, shape);
    for (const Triangle& triangle : shape.triangles) open += is_open(shape, body.scale, found->second, triangle);
    all += static_cast<double>(shape.triangles.size());
  }
  return open / all;
}

}  // namespace qdem
