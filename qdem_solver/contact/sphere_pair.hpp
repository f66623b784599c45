// Two contact spheres, or one and a plane: the force on their particles and the couples on their bodies.
#pragma once

#include "qdem_solver/contact/contact_law.hpp"
#include "qdem_solver/contact/rolling_law.hpp"

namespace qdem {

/// A sphere around a particle, part of a body whose turning it shares.
struct ContactSphere {
  Eigen::Vector3d centre, velocity;  ///< of the particle [m], [m/s]
  Eigen::Vector3d spin;              ///< of the body [rad/s]
  double radius = 0.0;               ///< [m]
  double rolling_inertia = 0.0;      ///< RigidBody::rolling_inertia() [kg m2]
};

/// How two spheres stand to each other, or a sphere (a) to a plane.
struct SphereMeeting {
  Eigen::Vector3d normal;           ///< unit, from b to a
  double gap = 0.0;                 ///< between the surfaces, negative where they overlap [m]
  double arm_a = 0.0, arm_b = 0.0;  ///< from each centre to the point of contact, along the line of centres [m]
  double rolling_radius = 0.0;      ///< see Rolling [m]
};

/// What the contact does. Force and moment of both sides vanish together: the tangential force acts in one point, and
/// each body gets the couple of bringing it from there to its particle.
struct SphereForce {
  Eigen::Vector3d force;               ///< on particle a; minus it acts on particle b [N]
  Eigen::Vector3d couple_a, couple_b;  ///< on the bodies [N m]
  Eigen::Vector3d slip, roll;          ///< of the springs
  double energy = 0.0;                 ///< of the springs [J]
  ContactPower dissipated;
};

/// Concentric spheres part along z.
HOUSE_HOST_DEVICE inline SphereMeeting meet(const Eigen::Vector3d& centre_a, double radius_a,
                                            const Eigen::Vector3d& centre_b, double radius_b) {
  const Eigen::Vector3d offset = centre_a - centre_b;
  const double distance = offset.norm(), gap = distance - radius_a - radius_b;
  const Eigen::Vector3d normal = distance > 0 ? Eigen::Vector3d(offset / distance) : Eigen::Vector3d(0, 0, 1);
  return {normal, gap, radius_a + gap / 2, radius_b + gap / 2, radius_a * radius_b / (radius_a + radius_b)};
}

/// `plane` at its place of `time` [s].
inline SphereMeeting meet(const Eigen::Vector3d& centre, double radius, const Plane& plane, double time) {
  const double height = plane.normal.dot(centre - plane.point - time * plane.velocity);
  return {plane.normal, height - radius, height, 0.0, radius};
}

/// Forces of spheres that overlap. Normal force along the line of centres, see VoigtCoulombLaw and RollingLaw; `b` of a
/// plane moves with it, without spin, and has infinite inertia.
inline SphereForce push_spheres(const ContactLaw& law, double friction, const SphereMeeting& meeting,
                                double effective_mass, const ContactSphere& a, const ContactSphere& b,
                                const Eigen::Vector3d& slip, const Eigen::Vector3d& roll, double dt) {
  const Eigen::Vector3d& n = meeting.normal;
  const Eigen::Vector3d arm_a = -meeting.arm_a * n, arm_b = meeting.arm_b * n;
  Touch touch;
  touch.normal = n, touch.overlap = -meeting.gap, touch.effective_mass = effective_mass;
  touch.normal_velocity = n.dot(a.velocity - b.velocity);
  touch.relative_velocity = a.velocity + a.spin.cross(arm_a) - b.velocity - b.spin.cross(arm_b);
  const TouchForce force = VoigtCoulombLaw(law, friction).push(touch, slip, dt);
  SphereForce result;
  result.force = force.normal * n + force.tangential;
  result.couple_a = arm_a.cross(force.tangential);
  result.couple_b = -arm_b.cross(force.tangential);
  result.slip = force.slip, result.roll.setZero();
  result.dissipated = force.dissipated;
  result.energy = spring_energy(law, touch.overlap, 1.0, force.slip);
  if (!(law.rolling_friction > 0)) return result;
  Rolling rolling;
  rolling.normal = n, rolling.relative_spin = a.spin - b.spin, rolling.normal_force = force.normal;
  rolling.radius = meeting.rolling_radius;
  rolling.inertia = joint_inertia(a.rolling_inertia, b.rolling_inertia);
  const RollingLaw rolling_law(law);
  const RollingCouple resistance = rolling_law.push(rolling, roll, dt);
  result.couple_a += resistance.couple, result.couple_b -= resistance.couple;
  result.roll = resistance.roll;
  result.dissipated += resistance.dissipated;
  result.energy += 0.5 * rolling_law.stiffness(rolling.radius) * resistance.roll.squaredNorm();
  return result;
}

}  // namespace qdem
