// The skin of one body as the contact kernels see it: where its nodes are now, which triangles and edges it has.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "proto/span.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// Addresses of one body's values, see model.hpp for the layout, and its skin: plain numbers and pointers, which
/// kernels on a device use, too.
struct SkinView {
  const Triangle* triangles;
  const Edge* edges;
  std::int64_t offset;  ///< of component 0 of node 0
  std::int64_t stride;  ///< between components
  double mass_factor;   ///< mass of a node = this x Template::node_volumes [kg/m3]
  double mass;          ///< of the body [kg]

  HOUSE_HOST_DEVICE Eigen::Vector3d at(const double* values, int node) const {
    const double* p = values + offset + 3 * stride * node;
    return {p[0], p[stride], p[2 * stride]};
  }
};

/// The same with what only the host knows of the body.
struct BodySkin : SkinView {
  const Template* shape;
  std::vector<double> radii;  ///< of the contact spheres around its nodes [m]; none with facets

  double node_mass(int node) const { return mass_factor * shape->node_volumes[node]; }
};

HOUSE_HOST_DEVICE inline double reduced_mass(const SkinView& a, const SkinView& b) {
  return a.mass * b.mass / (a.mass + b.mass);
}

/// Of every body; with spheres where the model's contact law has them.
std::vector<BodySkin> make_skins(const Model& model);

/// Current geometry of one skin triangle.
struct TriangleNow {
  std::array<Eigen::Vector3d, 3> x;
  Eigen::Vector3d area_vector;  ///< outward, twice the area [m2]

  HOUSE_HOST_DEVICE TriangleNow(const SkinView& skin, const double* positions, int triangle) {
    const auto& nodes = skin.triangles[triangle].nodes;
    for (int k = 0; k < 3; ++k) x[k] = skin.at(positions, nodes[k]);
    area_vector = (x[1] - x[0]).cross(x[2] - x[0]);
  }
};

/// A point that moves rigidly with a triangle, at it or off it: its velocity, and the forces on the corners that a
/// force at the point makes. The two are each other's transpose, so power is conserved; the corner forces have the
/// resultant and the moment of the force exactly, so momentum and angular momentum are too.
///
/// For a point at height h over the plane of the triangle with barycentric coordinates l_i and unit normal N:
///     v = sum l_i v_i - h sum (v_i . N) grad l_i      f_i = l_i F - h (F . grad l_i) N
class TriangleFrame {
 public:
  HOUSE_HOST_DEVICE TriangleFrame(const TriangleNow& triangle, const Eigen::Vector3d& point) {
    const double area2 = triangle.area_vector.squaredNorm();
    normal_ = triangle.area_vector / std::sqrt(area2);
    for (int k = 0; k < 3; ++k) {
      gradients_[k] = triangle.area_vector.cross(triangle.x[(k + 2) % 3] - triangle.x[(k + 1) % 3]) / area2;
    }
    const Eigen::Vector3d offset = point - triangle.x[0];
    height_ = normal_.dot(offset);
    weights_[1] = gradients_[1].dot(offset);
    weights_[2] = gradients_[2].dot(offset);
    weights_[0] = 1 - weights_[1] - weights_[2];
  }

  HOUSE_HOST_DEVICE Eigen::Vector3d velocity(const std::array<Eigen::Vector3d, 3>& v) const {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) result += weights_[k] * v[k] - height_ * v[k].dot(normal_) * gradients_[k];
    return result;
  }

  HOUSE_HOST_DEVICE Eigen::Vector3d corner_force(int corner, const Eigen::Vector3d& force) const {
    return weights_[corner] * force - height_ * force.dot(gradients_[corner]) * normal_;
  }

 private:
  Eigen::Vector3d normal_, weights_;
  std::array<Eigen::Vector3d, 3> gradients_;
  double height_;
};

}  // namespace qdem
