// How the material points of a discretised rail follow its degrees of freedom.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fem {

/// Share of one degree of freedom in one displacement component (0, 1, 2: x, y, z) of a point.
struct MotionWeight {
  int component;
  int dof;
  double weight;
};

/// What a rail of any kind tells about its points. Implementations reproduce rigid motions exactly.
class RailKinematics {
 public:
  virtual ~RailKinematics() = default;

  virtual int n_dofs() const = 0;

  /// Displacement of the rail's material at `point`, global frame [m], as a sum over degrees of freedom.
  /// Throws proto::Error (bad_data) for a point outside of the rail.
  virtual std::vector<MotionWeight> motion_at(const Eigen::Vector3d& point) const = 0;

  /// [n_dofs][6]: all degrees of freedom when the rail moves by 1 m along x, y, z, and by a linearised rotation of 1
  /// rad about axes through `centre` along x, y, z. The transpose gives the resultant of nodal loads and its moment.
  virtual Eigen::MatrixXd rigid_motions(const Eigen::Vector3d& centre) const = 0;
};

}  // namespace fem
