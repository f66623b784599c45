// The force between two touching points: Voigt normal and tangential, Coulomb slider with history.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "proto/span.hpp"
#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/energy_ledger.hpp"

namespace qdem {

/// How two features touch at one instant.
struct Touch {
  Eigen::Vector3d normal;             ///< unit, from b to a
  double overlap = 0.0;               ///< of the rounded surfaces [m], positive
  double normal_velocity = 0.0;       ///< rate of separation [m/s]
  Eigen::Vector3d relative_velocity;  ///< of a against b at the contact point [m/s]
  double effective_mass = 0.0;        ///< m_a m_b / (m_a + m_b) of the two bodies [kg]
  double share = 1.0;                 ///< factor on the tangential spring and both dashpots, see edge_pair.hpp [-]
};

/// Force on a [N] (minus it acts on b) and the spring elongation that goes with it.
struct TouchForce {
  double normal = 0.0;         ///< along Touch::normal, never negative [N]
  Eigen::Vector3d tangential;  ///< [N]
  Eigen::Vector3d slip;        ///< u_t [m]
  ContactPower dissipated;
};

/// `v` in the plane across the unit vector `n`, its length kept.
HOUSE_HOST_DEVICE inline Eigen::Vector3d turned_across(const Eigen::Vector3d& n, const Eigen::Vector3d& v) {
  const Eigen::Vector3d flat = v - n * n.dot(v);
  const double before = v.squaredNorm(), after = flat.squaredNorm();
  return after > 0 ? Eigen::Vector3d(flat * std::sqrt(before / after)) : flat;
}

/// Energy of the normal and the tangential spring [J].
HOUSE_HOST_DEVICE inline double spring_energy(const ContactLaw& law, double overlap, double share,
                                              const Eigen::Vector3d& slip) {
  return 0.5 * law.normal_stiffness * (overlap * overlap + law.tangential_ratio * share * slip.squaredNorm());
}

/// F_n = max(0, k_n delta - c_n v_n);  u_t turned into the tangent plane, then advanced by v_t dt;
/// F_t = -k_t u_t - c_t v_t, limited to mu F_n with u_t reset so that the spring carries the limit.
/// The slider yields by what of v_t does not go into the spring, v_s = v_t - u_t'; it dissipates -F_t . v_s, the
/// dashpots (k_n delta - F_n) v_n and c_t v_t . u_t'. With the springs' energies these add up to the power of the two
/// forces. c = 2 zeta sqrt(m_eff k), so that bodies that meet in one point part with the restitution that zeta stands
/// for, and the law's own dashpots beside it. The standard DEM law (Cundall and Strack 1979).
class VoigtCoulombLaw {
 public:
  HOUSE_HOST_DEVICE VoigtCoulombLaw(const ContactLaw& law, double friction)
      : kn_(law.normal_stiffness),
        kt_(law.normal_stiffness * law.tangential_ratio),
        cn_(law.normal_damping),
        ct_(law.tangential_damping),
        zeta2_(2 * law.damping_ratio),
        friction_(friction) {}

  HOUSE_HOST_DEVICE TouchForce push(const Touch& touch, const Eigen::Vector3d& slip, double dt) const {
    const Eigen::Vector3d& n = touch.normal;
    const double cn = (zeta2_ * std::sqrt(touch.effective_mass * kn_) + cn_) * touch.share;
    TouchForce result;
    result.normal = kn_ * touch.overlap - cn * touch.normal_velocity;
    if (!(result.normal > 0)) result.normal = 0;
    result.dissipated.dashpot = (kn_ * touch.overlap - result.normal) * touch.normal_velocity;
    result.tangential.setZero();
    result.slip.setZero();
    const double kt = kt_ * touch.share;
    if (!(friction_ > 0) || !(kt > 0)) return result;
    const Eigen::Vector3d vt = touch.relative_velocity - n * n.dot(touch.relative_velocity);
    const double ct = (zeta2_ * std::sqrt(touch.effective_mass * kt_) + ct_) * touch.share;
    const Eigen::Vector3d before = turned_across(n, slip);
    result.slip = before + vt * dt;
    Eigen::Vector3d stretch = vt;
    result.tangential = -kt * result.slip - ct * vt;
    const double size = result.tangential.norm(), limit = friction_ * result.normal;
    if (size > limit) {
      result.tangential *= limit / size;
      result.slip = -(result.tangential + ct * vt) / kt;
      stretch.setZero();
      if (dt > 0) stretch = (result.slip - before) / dt;
      result.dissipated.friction = -result.tangential.dot(vt - stretch);
    }
    result.dissipated.dashpot += ct * vt.dot(stretch);
    return result;
  }

 private:
  double kn_, kt_, cn_, ct_, zeta2_, friction_;
};

}  // namespace qdem
