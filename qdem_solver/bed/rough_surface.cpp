#include "qdem_solver/bed/rough_surface.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <map>

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

constexpr int n_waves = 6;
constexpr double wave_part = 0.8, noise_part = 0.6;  // squares sum to one

Polyhedron cut_in_four(const Polyhedron& shape) {
  Polyhedron fine;
  fine.corners = shape.corners;
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [found, is_new] = middles.emplace(std::minmax(a, b), static_cast<int>(fine.corners.size()));
    if (is_new) fine.corners.push_back(0.5 * (shape.corners[a] + shape.corners[b]));
    return found->second;
  };
  for (const auto& [a, b, c] : shape.faces) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

std::vector<Vector3d> corner_normals(const Polyhedron& shape) {
  std::vector<Vector3d> normals(shape.corners.size(), Vector3d::Zero());
  for (const auto& face : shape.faces) {
    const Vector3d& a = shape.corners[face[0]];
    const Vector3d area = (shape.corners[face[1]] - a).cross(shape.corners[face[2]] - a);
    for (const int corner : face) normals[corner] += area;
  }
  for (Vector3d& normal : normals) normal.normalize();
  return normals;
}

struct Wave {
  Vector3d number;
  double phase;
  explicit Wave(Random& random) {
    const Vector3d direction = random.direction();
    number = 2 * M_PI / random.uniform(0.33, 1.0) * direction;
    phase = random.uniform(0, 2 * M_PI);
  }
  double at(const Vector3d& x) const { return std::sqrt(2.0 / n_waves) * std::sin(number.dot(x) + phase); }
};

}  // namespace

Polyhedron roughened(Polyhedron shape, const Roughness& roughness, Random& random) {
  while (static_cast<int>(shape.faces.size()) < roughness.least_facets) shape = cut_in_four(shape);
  std::vector<Wave> waves;
  for (int i = 0; i < n_waves; ++i) waves.emplace_back(random);
  const auto normals = corner_normals(shape);
  for (std::size_t i = 0; i < shape.corners.size(); ++i) {
    double wave = 0.0;
    for (const Wave& w : waves) wave += w.at(shape.corners[i]);
    const double noise = random.uniform(-1, 1) * std::sqrt(3.0);
    shape.corners[i] += roughness.height * (wave_part * wave + noise_part * noise) * normals[i];
  }
  return shape;
}

}  // namespace qdem::bed
