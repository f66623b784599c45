// The artificial boundary of a body that is cut out of an unbounded ground.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace qdem {

struct Model;
struct State;

/// A particle on an artificial boundary: the ground beyond it as springs and dashpots along the axes.
struct BoundaryParticle {
  int body = 0, node = 0;
  Eigen::Vector3d rest = Eigen::Vector3d::Zero();       ///< where its springs are unstretched [m]
  Eigen::Vector3d stiffness = Eigen::Vector3d::Zero();  ///< along x, y, z [N/m]
  Eigen::Vector3d damping = Eigen::Vector3d::Zero();    ///< along x, y, z [N s/m]
};

/// Surface triangles of a body whose outward normal is the axis (0 to 2), `side` +1 along it, -1 against it.
struct BoxFace {
  int axis, side;
};

/// How waves spread on their way to the boundary.
enum class Spreading {
  from_line,   ///< as cylinders around a line along x
  from_point,  ///< as balls
};

/// Where they come from, and how stiff the ground beyond the boundary is.
struct FarField {
  Eigen::Vector3d source = Eigen::Vector3d::Zero();  ///< centre of the loads [m]
  Spreading spreading = Spreading::from_line;
  double normal_stiffness = 1.0;      ///< alpha_N [-]
  double tangential_stiffness = 0.5;  ///< alpha_T [-]
};

/// Viscous-spring boundary on the `faces` of a body whose particles stand at `state`. A particle with the share A of
/// the boundary's area (a third of each of its triangles) at the distance R from the source gets
///     normal: c = rho c_p A, k = alpha_N G A/R        tangential: c = rho c_s A, k = alpha_T G A/R
/// of the body's elastic constants, summed over the faces it lies on. Dashpots: Lysmer and Kuhlemeyer 1969, J. Eng.
/// Mech. Div. 95, 859-877. Springs: Liu, Du, Du, Wang and Wu 2006, Earthq. Eng. Eng. Vib. 5, 93-102, commonly quoted
/// with alpha 1 and 1/2 for a line, 4/3 and 2/3 for a point. Throws proto::Error (bad_data) where the body has no such
/// face.
std::vector<BoundaryParticle> absorbing_boundary(const Model& model, const State& state, int body,
                                                 const std::vector<BoxFace>& faces, const FarField& far);

}  // namespace qdem
