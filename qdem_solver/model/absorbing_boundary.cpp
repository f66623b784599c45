#include "qdem_solver/model/absorbing_boundary.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <map>

#include "proto/error.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {
namespace {

using Eigen::Vector3d;

constexpr double flatness = 1e-6;  // of a face: 1 - cosine of the angle between its triangles' normals and the axis

double distance_of(const FarField& far, const Vector3d& point) {
  Vector3d way = point - far.source;
  if (far.spreading == Spreading::from_line) way[0] = 0.0;
  return way.norm();
}

}  // namespace

std::vector<BoundaryParticle> absorbing_boundary(const Model& model, const State& state, int body,
                                                 const std::vector<BoxFace>& faces, const FarField& far) {
  const Material& ground = model.material(body);
  const double shear_modulus = ground.mu(), p_modulus = ground.lambda() + 2 * shear_modulus;
  const double normal_damping = std::sqrt(ground.density * p_modulus);  // rho c_p
  const double tangential_damping = std::sqrt(ground.density * shear_modulus);
  std::map<int, BoundaryParticle> particles;
  for (const BoxFace& face : faces) {
    bool found = false;
    for (const Triangle& triangle : model.shape(body).triangles) {
      Vector3d x[3];
      for (int k = 0; k < 3; ++k) x[k] = state.position(model, body, triangle.nodes[k]);
      const Vector3d twice = (x[1] - x[0]).cross(x[2] - x[0]);
      if (face.side * twice[face.axis] < (1 - flatness) * twice.norm()) continue;
      found = true;
      for (int k = 0; k < 3; ++k) {
        const int node = triangle.nodes[k];
        const double area = twice.norm() / 6, spread = shear_modulus * area / distance_of(far, x[k]);
        BoundaryParticle& particle = particles[node];
        particle.body = body, particle.node = node, particle.rest = x[k];
        for (int c = 0; c < 3; ++c) {
          const bool normal = c == face.axis;
          particle.stiffness[c] += (normal ? far.normal_stiffness : far.tangential_stiffness) * spread;
          particle.damping[c] += (normal ? normal_damping : tangential_damping) * area;
        }
      }
    }
    if (!found) {
      throw proto::Error(proto::ExitCode::bad_data, "the body has no plane face for an absorbing boundary",
                         "body '" + model.bodies[body].name + "', axis " + std::to_string(face.axis));
    }
  }
  std::vector<BoundaryParticle> result;
  for (const auto& [node, particle] : particles) result.push_back(particle);
  return result;
}

}  // namespace qdem
