// Torsion constant and shear coefficients of a cross-section from its shape.
#pragma once

#include "fem_solver/model/rail_section.hpp"

namespace fem {

/// What a beam needs of a section besides area and second moments.
struct ShearConstants {
  double torsion_constant = 0.0;  ///< Saint-Venant's J [m4]
  double vertical = 0.0;  ///< shear coefficient kappa: shear area over area, from the energy of the shear stress
  double lateral = 0.0;   ///< the same across
};

/// Solves Saint-Venant's torsion and Jourawski's shear flow on the section (Timoshenko and Goodier, Theory of
/// Elasticity, chapters 10 and 12, shear for a Poisson's ratio of zero) with bilinear elements, `divisions` along each
/// side of a block:
///
///     torsion: div(grad w + (-z, y)) = 0,  J = integral |grad w + (-z, y)|^2
///     shear:   laplace psi = -z/I,  d psi/dn = 0,  kappa = 1/(A integral |grad psi|^2)
///
/// Both energies converge from one side with the square of the element size.
ShearConstants shear_constants(const RailSection& section, int divisions = 12);

}  // namespace fem
