// A wheel as the contact point and the axle see it: a few masses, modes and springs.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "fem_solver/model/settings.hpp"

namespace fem {

/// Vertical motion of a wheel of any kind in a frame that travels with it and does not spin:
///
///     M u'' + C u' + K u = contact F - load,   u_0: hub,   contact . u: tread at the contact point, up
///
/// The matrices are symmetric and dense; a wheel that is free of the rail moves as rigid without straining K.
/// Immutable.
struct WheelModel {
  Eigen::MatrixXd mass;       ///< [kg]
  Eigen::MatrixXd damping;    ///< [N s/m]
  Eigen::MatrixXd stiffness;  ///< [N/m]
  Eigen::VectorXd contact;    ///< displacement of the contact point per unit of each degree of freedom
  Eigen::VectorXd load;       ///< static forces downwards; their sum is the static load [N]
  Eigen::VectorXd rigid;      ///< the motion of all degrees of freedom when the whole wheel moves by 1
  /// Flattening under the patch that the model's own contact point shows; the contact law has it already, so that it is
  /// taken out [m/N].
  double local_flexibility = 0.0;

  int n_dofs() const { return static_cast<int>(load.size()); }
  double static_load() const { return rigid.dot(load); }  ///< [N]
};

/// Degrees of freedom of a wheel.
struct WheelMotion {
  Eigen::VectorXd displacement;  ///< [m]
  Eigen::VectorXd velocity;      ///< [m/s]

  double hub() const { return displacement[0]; }
  double hub_velocity() const { return velocity[0]; }
};

/// The unsprung mass as one point, on the primary suspension where the settings have one.
WheelModel mass_wheel(const WheelSettings& settings);

/// Displacement of the contact point of a wheel at rest, its flattening left out [m].
inline double resting_contact(const WheelModel& wheel, const WheelMotion& motion) {
  return wheel.contact.dot(motion.displacement) - wheel.local_flexibility * wheel.static_load();
}

/// Adds the primary suspension of the settings to a wheel: a spring and a dashpot between the hub and the sprung mass,
/// which carries what the static load exceeds the weight of the unsprung mass.
void add_suspension(WheelModel& wheel, const WheelSettings& settings);

/// Builds the wheel of a case.
using WheelBuilder = std::function<WheelModel(const WheelSettings&)>;

/// The rest of a wheel whose contact point lies at `contact` [m] under its static load.
WheelMotion wheel_at_rest(const WheelModel& wheel, double contact);

/// Average acceleration over windows of one length, as the track's Newmark: linear in the contact force's mean F.
class WheelStepper {
 public:
  /// `step`: [s]. `wheel` must outlive it.
  WheelStepper(const WheelModel& wheel, double step);

  /// Mean displacement of the contact point over a window with F = 0 [m].
  double free_displacement(const WheelMotion& motion) const;
  /// Mean velocity of the contact point per F [m/(N s)].
  double response() const { return response_; }
  /// Motion at the window's end.
  void finish(WheelMotion& motion, double contact_force) const;

 private:
  Eigen::VectorXd mean_velocity(const WheelMotion& motion, double contact_force) const;

  const WheelModel& wheel_;
  double step_;
  Eigen::MatrixXd inverse_;  // of M/(H/2) + C + K H/2
  double response_;
};

}  // namespace fem
