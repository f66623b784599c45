// The rail as quadratic hexahedra: nodes, elasticity matrices, interpolation. The only door to deal.II.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "fem_solver/assembly/rail_kinematics.hpp"
#include "fem_solver/linear/sparse_matrix.hpp"
#include "fem_solver/model/material.hpp"
#include "fem_solver/model/rail_section.hpp"

namespace fem {

/// Value of a nodal field at one place as a weighted sum over nodes.
struct NodeWeights {
  std::vector<int> nodes;
  std::vector<double> weights;
};

/// Extruded mesh of a cross-section along x with Q2 Lagrange elements. Degree of freedom 3 n + c is component c (x, y,
/// z) of node n. Immutable after construction.
class RailMesh : public RailKinematics {
 public:
  /// `planes`: ascending x of the element boundaries [m]; `lateral`: y of the section's plane of symmetry [m]. The
  /// foot's bottom face lies at z = 0. Throws proto::Error (bad_data) for fewer than two planes or an inverted element.
  RailMesh(const RailSection& section, const std::vector<double>& planes, double lateral);
  ~RailMesh() override;

  int n_nodes() const;
  int n_dofs() const override { return 3 * n_nodes(); }
  std::vector<MotionWeight> motion_at(const Eigen::Vector3d& point) const override;
  Eigen::MatrixXd rigid_motions(const Eigen::Vector3d& centre) const override;
  int n_elements() const;
  const RailSection& section() const;
  const std::vector<double>& planes() const;
  double lateral() const;
  const std::vector<Eigen::Vector3d>& nodes() const;

  /// Lower triangle of the stiffness matrix of linear elasticity, 3 x 3 x 3 Gauss points [N/m].
  SparseMatrix stiffness(const Material& material) const;

  /// Volume that the 3 x 3 x 3 Gauss-Lobatto rule gives each node [m3]: positive, sums to the mesh's volume. Times the
  /// density it is the lumped mass, of the same order in the element size as the consistent one.
  Eigen::VectorXd node_volumes() const;

  /// Area that each node holds of the two end faces [m2], zero inside.
  Eigen::VectorXd end_face_areas() const;

  /// Shape functions at a point of the mesh, global frame [m]. They sum to one and reproduce linear fields.
  /// Throws proto::Error (bad_data) for a point outside.
  NodeWeights interpolation(const Eigen::Vector3d& point) const;

  /// Mean over the cross-section in plane `plane` (index into planes()): nodes of that plane, weights sum to one.
  NodeWeights section_mean(int plane) const;

  /// Corner nodes of each element in the order of a VTK hexahedron.
  std::vector<std::array<int, 8>> hexahedra() const;

  /// Von Mises stress at each element's centre for the displacement `u` [m] of all degrees of freedom [Pa].
  std::vector<double> von_mises(const Eigen::VectorXd& u, const Material& material) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace fem
