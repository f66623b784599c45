// The rail as quadratic hexahedra: an extruded cross-section.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "fem_solver/assembly/rail_kinematics.hpp"
#include "fem_solver/assembly/solid_mesh.hpp"
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

  /// The elements, with their matrices. Cells count the blocks of a slab first, then the slabs.
  const SolidMesh& solid() const;

  /// Area that each node holds of the two end faces [m2], zero inside.
  Eigen::VectorXd end_face_areas() const;

  /// Shape functions at a point of the mesh, global frame [m]. They sum to one and reproduce linear fields.
  /// Throws proto::Error (bad_data) for a point outside.
  NodeWeights interpolation(const Eigen::Vector3d& point) const;

  /// Mean over the cross-section in plane `plane` (index into planes()): nodes of that plane, weights sum to one.
  NodeWeights section_mean(int plane) const;

  /// Corner nodes of each element in the order of a VTK hexahedron.
  std::vector<std::array<int, 8>> hexahedra() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace fem
