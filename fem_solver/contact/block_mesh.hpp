// A block of finite elements that stands for a body in contact.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem_solver/contact/hertz.hpp"
#include "fem_solver/linear/sparse_matrix.hpp"

namespace fem {

/// A quarter of a block, x and y >= 0, the surface z = 0 on top, refined towards its corner at the origin.
struct BlockShape {
  double semi_axis_x = 1.0, semi_axis_y = 1.0;  ///< of the patch that is expected [m]
  int elements = 16;                            ///< to a semi-axis, even
  double margin = 1.25;                         ///< width of the finest surface over the patch's
};

/// What the block is loaded by on its surface: it says what the planes x = 0 and y = 0 do.
enum class BlockLoad {
  pressing,  ///< along z, even in x and y
  shearing   ///< along x, even in x and y
};

/// Equations of the block. Far from the patch (20 to 40 semi-axes) its sides and bottom move as a half-space does under
/// a force at the origin: Boussinesq's or Cerruti's solution (Johnson, Contact Mechanics, 3.18 and 3.75).
struct BlockSystem {
  SparseMatrix stiffness;                   ///< lower triangle; fixed degrees of freedom have a diagonal alone [N/m]
  Eigen::VectorXd far_load;                 ///< right side from the far motion under a unit force on the whole body
  int n_side = 0;                           ///< nodes along a side of the finest surface, from the origin
  double dx = 0.0, dy = 0.0;                ///< their distances [m]
  std::vector<std::array<int, 3>> surface;  ///< degrees of freedom of the node (i, j): [i + n_side * j]
  std::vector<char> is_fixed;               ///< per degree of freedom, by symmetry or far away
  int n_cells = 0;
};

/// Trilinear hexahedra with hanging nodes. Throws proto::Error (bad_data).
BlockSystem build_block(const BlockShape& shape, const ElasticBody& body, BlockLoad load);

}  // namespace fem
