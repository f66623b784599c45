// A deformable body taken as a rigid one: where its centre is, how it turns, and how a couple acts on its particles.
#pragma once

#include <Eigen/LU>

#include "qdem_solver/contact/body_skin.hpp"

namespace qdem {

/// Mass and inertia of the particles of a body where they are now.
struct RigidBody {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of mass [m]
  double inverse_mass = 0.0;                         ///< [1/kg]
  Eigen::Matrix3d inverse_inertia;                   ///< about the centre [1/(kg m2)]

  RigidBody(const BodySkin& skin, const double* positions) : inverse_mass(1 / skin.mass) {
    const int n = skin.shape->n_nodes();
    for (int i = 0; i < n; ++i) centre += skin.node_mass(i) / skin.mass * skin.at(positions, i);
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector3d arm = skin.at(positions, i) - centre;
      moment += skin.node_mass(i) * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
    }
    inverse_inertia = moment.inverse();
  }

  /// Bound of how far a unit force at `point` moves it, times its unit inertia [1/kg].
  double mobility(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d r = point - centre;
    Eigen::Matrix3d cross;
    cross << 0, -r[2], r[1], r[2], 0, -r[0], -r[1], r[0], 0;
    return inverse_mass + (cross * inverse_inertia * cross.transpose()).norm();
  }

  /// I + m radius^2, I the harmonic mean of the principal moments [kg m2].
  double rolling_inertia(double radius) const { return 3 / inverse_inertia.trace() + radius * radius / inverse_mass; }

  /// I^-1 times the angular momentum about the centre [rad/s].
  Eigen::Vector3d spin(const BodySkin& skin, const double* positions, const double* velocities) const {
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
    for (int i = 0; i < skin.shape->n_nodes(); ++i) {
      momentum += skin.node_mass(i) * (skin.at(positions, i) - centre).cross(skin.at(velocities, i));
    }
    return inverse_inertia * momentum;
  }

  /// The share of node `i` in a couple [N m]: m_i (I^-1 couple) x (x_i - centre) [N]. The shares have no resultant and
  /// the couple as their moment, turn the body without deforming it, and do the work couple . spin().
  Eigen::Vector3d couple_share(const BodySkin& skin, const double* positions, int i,
                               const Eigen::Vector3d& couple) const {
    return skin.node_mass(i) * (inverse_inertia * couple).cross(skin.at(positions, i) - centre);
  }
};

}  // namespace qdem
