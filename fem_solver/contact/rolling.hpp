// A patch that rolls: the shear traction is carried along with the material.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fem_solver/contact/tangential_patch.hpp"

namespace fem {

/// Rigid slip of the wheel over the rail per distance rolled: xi - phi y along x, eta + phi x along y.
struct Creepage {
  double longitudinal = 0.0;  ///< xi, positive where the wheel's surface runs ahead (braking) [-]
  double lateral = 0.0;       ///< eta [-]
  double spin = 0.0;          ///< phi [1/m]
};

/// Of all tractions on the wheel, about the grid's centre.
struct ShearResultant {
  double longitudinal = 0.0, lateral = 0.0;  ///< [N]
  double moment = 0.0;                       ///< about the normal [N m]
};

ShearResultant resultant(const PatchGrid& grid, const PatchVectors& traction);

enum class Zone : std::uint8_t { open, stick, slip };

/// Slip where the traction has reached the bound within 1e-6.
std::vector<Zone> zones(const PatchField& bound, const PatchVectors& traction);

/// Friction on a grid that travels with the patch along +x. A particle at x was at x + travel one step before; the
/// displacement that it had there is taken from the influence functions at that very point, so that nothing is
/// interpolated. Slip over a step (Kalker 1990): s = (rigid slip) + u(x) - u_before(x + travel).
class RollingPatch {
 public:
  RollingPatch(const PatchGrid& grid, const PairElasticity& pair);

  const PatchGrid& grid() const { return patch_.grid(); }

  /// One step of `travel` [m] > 0, at most the length of an element for a good resolution. `before`: traction at its
  /// beginning; `bound`: friction times pressure at its end. Slip is that of the step [m]. Throws as
  /// TangentialPatch::solve().
  TangentialSolution step(const PatchField& bound, const PatchVectors& before, const Creepage& creepage, double travel,
                          const char* where);

  /// Steps of one element until a step changes no traction by more than 1e-5 of the largest: steady rolling. Throws
  /// (numerics) with the changes after twenty lengths of the grid. Slip is that of one step.
  TangentialSolution steady(const PatchField& bound, const PatchVectors& before, const Creepage& creepage,
                            const char* where);

  /// The wheel is shifted by (x, y) [m] without rolling, from no traction.
  TangentialSolution shifted(const PatchField& bound, double x, double y, const char* where) const;

 private:
  PairElasticity pair_;
  TangentialPatch patch_;
  double travel_ = 0.0;
  std::unique_ptr<TangentialInfluence> ahead_;  // its points a travel before the elements
};

}  // namespace fem
