// The bonds of ordinary DEM on a template: one between the two particles of every edge of its tetrahedra.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "qdem_solver/model/adjacency.hpp"
#include "qdem_solver/model/model.hpp"

namespace qdem {

/// Bonds of a template, in ascending order of their nodes.
///
/// A tetrahedron of volume V_e gives each of its six bonds the stiffness 6 E V_e / sum L^2. With k_b L_b^2 / V the
/// weight of a bond's direction n, a network that deforms uniformly has C = sum k_b L_b^2 n n n n / V; for directions
/// without preference that is lambda = mu = 6 E / 15, hence the wanted E and, whatever is asked, Poisson's ratio 1/4
/// (Cauchy's relations of central forces; derived here, see Ostoja-Starzewski, Appl. Mech. Rev. 55, 2002, on lattices).
/// Equal shares within a tetrahedron make a box of mirrored cubes exactly isotropic.
///
/// Real networks deform unevenly, at the surface above all, and are softer, or have preferred directions. As usual in
/// DEM, the specimen is therefore pulled, along the longest side of its box, and all bonds are scaled by one factor so
/// that it answers with E.
struct BondNetwork {
  std::vector<std::array<int, 2>> nodes;  ///< the lower first
  std::vector<double> lengths;            ///< at rest, scale 1 [m]
  std::vector<double> stiffness;          ///< k_b / E at scale 1 [m]; of a body of scale s, s times as much
  double calibration = 1.0;               ///< the factor of the pulled specimen, part of `stiffness` [-]
  Adjacency adjacency;
};

/// The six edges of a tetrahedron, by corner.
inline constexpr int tet_edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/// Stiffness over E that a tetrahedron gives to each of its bonds, not calibrated, scale 1 [m].
double bond_share(const Template& shape, int tet);

/// Throws proto::Error (numerics) when the specimen cannot be pulled.
BondNetwork make_bond_network(const Template& shape);

/// The bonds that make_batches() made. Throws std::logic_error where it was not asked for any.
const BondNetwork& bonds_of(const Template& shape);

/// Stiffness matrix over E of small displacements, value 3 * node + component, scale 1 [m].
Eigen::SparseMatrix<double> bond_stiffness(const Template& shape, const BondNetwork& bonds);

}  // namespace qdem
