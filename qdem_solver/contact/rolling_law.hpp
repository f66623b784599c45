// The couple by which two touching spheres resist rolling on each other.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "proto/span.hpp"
#include "qdem_solver/contact/contact_law.hpp"

namespace qdem {

/// Two spheres that may roll on each other, or a sphere on a plane.
struct Rolling {
  Eigen::Vector3d normal;         ///< unit, from b to a
  Eigen::Vector3d relative_spin;  ///< of a against b [rad/s]
  double radius = 0.0;            ///< r_a r_b / (r_a + r_b), against a plane r_a [m]
  double inertia = 0.0;           ///< 1 / sum 1/(I + m r^2) over the bodies [kg m2]
  double normal_force = 0.0;      ///< [N]
};

/// Rolling::inertia from I + m r^2 of both sides (a plane's is infinite) [kg m2].
HOUSE_HOST_DEVICE inline double joint_inertia(double a, double b) {
  return 1 / (1 / a + 1 / b);
}

/// Couple on a [N m] (minus it acts on b) and the spring's turn that goes with it [rad].
struct RollingCouple {
  Eigen::Vector3d couple, roll;
  ContactPower dissipated;
};

/// theta turned into the tangent plane, then advanced by the relative spin across the normal;
/// M = -k_r theta, its size at most mu_r R F_n with theta reset so that the spring carries the limit; below the limit a
/// dashpot of 2 zeta sqrt(I k_r) acts beside it. k_r = 2.25 k_n (mu_r R)^2. This is the elastic-plastic
/// spring-dashpot model C of Ai, Chen, Rotter and Ooi, Powder Technology 206 (2011) 269, with the damping off while it
/// rolls. Twist about the normal is not resisted.
class RollingLaw {
 public:
  HOUSE_HOST_DEVICE explicit RollingLaw(const ContactLaw& law)
      : kn_(law.normal_stiffness), zeta2_(2 * law.damping_ratio), friction_(law.rolling_friction) {}

  /// k_r [N m] for a rolling radius [m].
  HOUSE_HOST_DEVICE double stiffness(double radius) const {
    const double arm = friction_ * radius;
    return 2.25 * kn_ * arm * arm;
  }

  /// [N m s]
  HOUSE_HOST_DEVICE double dashpot(double radius, double inertia) const {
    return zeta2_ * std::sqrt(inertia * stiffness(radius));
  }

  HOUSE_HOST_DEVICE RollingCouple push(const Rolling& rolling, const Eigen::Vector3d& roll, double dt) const {
    const Eigen::Vector3d& n = rolling.normal;
    const Eigen::Vector3d spin = rolling.relative_spin - n * n.dot(rolling.relative_spin);
    const double kr = stiffness(rolling.radius), limit = friction_ * rolling.radius * rolling.normal_force;
    RollingCouple result;
    const Eigen::Vector3d before = turned_across(n, roll);
    result.roll = before + spin * dt;
    result.couple = -kr * result.roll;
    const double size = result.couple.norm();
    if (size > limit) {
      result.couple *= limit / size;
      result.roll *= limit / size;
      Eigen::Vector3d stretch = Eigen::Vector3d::Zero();
      if (dt > 0) stretch = (result.roll - before) / dt;
      result.dissipated.friction = -result.couple.dot(spin - stretch);
    } else {
      const Eigen::Vector3d damping = dashpot(rolling.radius, rolling.inertia) * spin;
      result.couple -= damping;
      result.dissipated.dashpot = damping.dot(spin);
    }
    return result;
  }

 private:
  double kn_, zeta2_, friction_;
};

}  // namespace qdem
