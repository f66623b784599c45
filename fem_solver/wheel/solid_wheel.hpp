// The wheel of solid elements, condensed to its hub and its contact point.
#pragma once

#include <vector>

#include "fem_solver/wheel/wheel_mesh.hpp"
#include "fem_solver/wheel/wheel_model.hpp"

namespace fem {

/// A wheel clamped at its bore, reduced to vectors that a vertical force at the contact point and a vertical shake of
/// the bore excite.
struct ReducedWheel {
  double mass = 0.0;                 ///< of the mesh [kg]
  Eigen::VectorXd circular_squared;  ///< (2 pi f)^2 of the modes with the bore held, ascending [1/s2]
  Eigen::VectorXd participation;     ///< mass that a mode moves upwards, per unit modal mass [sqrt(kg)]
  Eigen::VectorXd contact;           ///< motion of the contact point in each mode [1/sqrt(kg)]
  double local_flexibility = 0.0;    ///< mean displacement under the same patch on a half-space [m/N]

  /// Of the contact point against the bore, without the flattening under the patch [m/N].
  double flexibility() const {
    return contact.cwiseProduct(contact).cwiseQuotient(circular_squared).sum() - local_flexibility;
  }
};

/// Reduces a meridian turned about the axle by load-dependent Ritz vectors (Wilson, Yuan and Dickens, Earthquake
/// Engineering and Structural Dynamics 10 (1982)): K^-1 of contact force and bore shake, then K^-1 M again and again,
/// `n_blocks` pairs. Static displacement of the contact point is exact, so that no residual term is needed. The force
/// is a uniform pressure over two elements along the tread and the web's width across. The body's spin (gyroscopic and
/// convective terms) is left out.
ReducedWheel reduce_wheel(const Meridian& meridian, const Material& material, double finest_angle, int n_blocks);

/// The wheel of the settings, mass completed at the hub to the unsprung mass, with suspension. Throws proto::Error
/// (bad_data) for a wheel that is heavier than the unsprung mass, and what wheel_meridian() throws.
WheelModel solid_wheel(const WheelSettings& settings);

/// A WheelBuilder: solid_wheel() or mass_wheel() as the settings say.
WheelModel build_wheel(const WheelSettings& settings);

}  // namespace fem
