// What the window of wheel and track needs of a contact.
#pragma once

#include <functional>
#include <memory>

#include "fem_solver/contact/rolling.hpp"

namespace fem {

/// Force of a contact at one approach, and how it rises.
struct ContactForce {
  double force = 0.0;    ///< >= 0 [N]
  double tangent = 0.0;  ///< d force/d approach [N/m]
};

/// Normal force over the approach [m]. Calls may warm-start each other: the results depend on their order alone.
using ContactLaw = std::function<ContactForce(double approach)>;

/// Fields of a patch and the rotation of its wheel. Empty fields: the contact is a spring.
struct PatchState {
  PatchField pressure;         ///< [Pa]
  PatchVectors traction;       ///< on the wheel [Pa]
  PatchVectors slip;           ///< of the wheel over the rail, per distance rolled [-]
  double running_ahead = 0.0;  ///< circumferential less forward speed of the wheel [m/s]
};

/// F = C_H delta^1.5 at an approach from touching, zero when open.
ContactLaw hertz_law(double coefficient);

/// A wheel's contact with the rail. Positions are along the rail [m], approaches count from the undeformed surfaces
/// touching at the wheel's place [m].
class WheelContact {
 public:
  virtual ~WheelContact() = default;

  /// The state of a wheel that stands at `position` under its static load; `approach` receives how deep.
  virtual PatchState at_rest(double position, double& approach) const = 0;

  /// Normal law at `position`, starting from `state`.
  virtual ContactLaw law(double position, const PatchState& state) const = 0;

  /// Carries the state over one window with its mid-window place and approach.
  virtual void roll(double position, double approach, PatchState& state) = 0;
};

}  // namespace fem
