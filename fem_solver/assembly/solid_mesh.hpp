// Quadratic hexahedra of any body: nodes, elasticity matrices. The only door to deal.II.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "fem_solver/linear/sparse_matrix.hpp"
#include "fem_solver/model/material.hpp"

namespace fem {

/// Corners and cells of a mesh. Corners of a cell in lexicographic order: first direction fastest; right-handed.
struct HexahedronMesh {
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<std::array<int, 8>> cells;
};

/// How edges run between the corners: straight, or as the lines of cylinder coordinates about the y axis.
enum class Edges { straight, revolved_about_y };

/// Q2 Lagrange elements. Degree of freedom 3 n + c is component c (x, y, z) of node n. Immutable after construction.
class SolidMesh {
 public:
  static constexpr int nodes_per_element = 27;

  /// Throws proto::Error (bad_data, `where`) for an inverted or distorted element.
  SolidMesh(const HexahedronMesh& mesh, Edges edges, const char* where);
  ~SolidMesh();

  int n_nodes() const;
  int n_dofs() const { return 3 * n_nodes(); }
  int n_elements() const;
  const std::vector<Eigen::Vector3d>& nodes() const;
  /// Nodes of the cell with index `element` of the mesh, in deal.II's order: corners first.
  const std::vector<int>& element_nodes(int element) const;

  /// Lower triangle of the stiffness matrix of linear elasticity, 3 x 3 x 3 Gauss points [N/m].
  SparseMatrix stiffness(const Material& material) const;

  /// Volume that the 3 x 3 x 3 Gauss-Lobatto rule gives each node [m3]: positive, sums to the mesh's volume. Times the
  /// density it is the lumped mass, of the same order in the element size as the consistent one.
  Eigen::VectorXd node_volumes() const;

  /// Value of an element's shape function `node` at a point of the unit cube.
  double shape_value(int node, const Eigen::Vector3d& local) const;

  /// Von Mises stress at each element's centre for the displacement `u` [m] of all degrees of freedom [Pa].
  std::vector<double> von_mises(const Eigen::VectorXd& u, const Material& material) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace fem
