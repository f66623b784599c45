// Transfer of motions and forces between two point sets of one patch.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace coupler {

using Points = std::vector<Eigen::Vector3d>;

/// What brings displacements from one point set to another; its transpose brings forces back.
struct PatchMap {
  Eigen::MatrixXd matrix;   ///< [3 n_to][3 n_from], three components a point, in the axes of the points
  int n_rigid_motions = 6;  ///< how many of the six are carried to round-off; fewer where `from` cannot show them
};

/// Consistent interpolation of vector fields from `from` to `to` [m], both in the same axes:
///
///     u_to = Q P^+ u_from + (Phi_to Phi_from^-1) (1 - P P^+) u_from
///
/// P, Q: a basis of linear fields at the two sets, fitted by least squares (a rank-revealing QR drops what `from` does
/// not determine); Phi: compactly supported radial functions (Wendland's C2, support four radii of the set) for what
/// the fit leaves. Along directions in which `from` has less than a twentieth of its largest spread (none for a volume,
/// one for a plane, two for a line, three for a point) a field has no gradient of its own: there the normal turns with
/// the patch, without strain. So rigid motions come over to round-off, and with them sums of force and moment under the
/// transpose, also to points off the plane; of a line the twist about itself is not seen, of a point no rotation.
///
/// Source: Beckert and Wendland 2001 (radial functions with a polynomial, forces by the transpose); the polynomial
/// apart from the radial part and its rank by QR: Lindner, Mehl and Uekermann 2017. The terms off the plane: this
/// project.
///
/// `from` and `to` are not empty. Throws proto::Error (protocol) when two points of `from` are closer to each other
/// than 1e-6 of the set's radius.
PatchMap map_patch(const Points& from, const Points& to);

}  // namespace coupler
