// The ground under the ballast as a layer of elements that goes on beyond its mesh.
#pragma once

#include <cmath>
#include <string>

#include "qdem_solver/model/model.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// `[qdem.subgrade]` of kind "layer": a box below the bay, from the track's centre outward.
struct SubgradeLayer {
  Material material;  ///< always of quadruples
  double thickness = 0.0;
  double width = 0.0;    ///< from the track's centre to the absorbing side [m]
  double element = 0.0;  ///< edge of the bricks that are cut into tetrahedra [m]
  /// Of the springs at bottom and side, FarField's alpha [-].
  double normal_stiffness = 1.0, tangential_stiffness = 0.5;
  double highest_frequency = 0.0;  ///< that shall be resolved; 0: not asked [Hz]

  /// Up to which the bricks resolve a shear wave, ten of them on its length [Hz] (Kuhlemeyer and Lysmer 1973, J. Soil
  /// Mech. Found. Div. 99, 421-427: eight to ten).
  double resolved_frequency() const { return std::sqrt(material.mu() / material.density) / (10 * element); }
};

/// One line for a user who asked for a higher frequency than that; empty for others.
std::string too_coarse(const SubgradeLayer& layer);

namespace bed {

/// Lays the layer as a last body, of kind ground, under the stones of a bed whose plane 0 is rigid ground: where that
/// plane was, so that every contact on it goes on as it is. The plane goes down to the layer's bottom. Bottom and far
/// side absorb; the bay's planes and y = 0 are planes of symmetry. Returns where the plane was [m].
double lay_subgrade(Model& model, State& state, const SubgradeLayer& layer);

}  // namespace bed
}  // namespace qdem
