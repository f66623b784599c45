// Rail, supports and interface as matrices: what the time integration works with, whatever the rail is made of.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem_solver/assembly/rail_kinematics.hpp"
#include "fem_solver/linear/sparse_matrix.hpp"
#include "fem_solver/model/interface_law.hpp"
#include "fem_solver/model/rail_section.hpp"
#include "fem_solver/model/settings.hpp"
#include "proto/case/rail_seat.hpp"

namespace fem {

/// Which seats the rail's own model leaves to the coupling partner.
enum class SeatOwner { partner, own_supports };

/// The semi-discrete track: degrees of freedom of the rail first, then three translations per supporting sleeper.
///
///     M u'' + (C_s + b K_r) u' + (K_r + K_s) u = load
///
/// Immutable after build. Symmetric matrices are stored as their lower triangle.
struct TrackSystem {
  std::vector<proto::RailSeat> coupled_seats;  ///< in the order of the case; empty with SeatOwner::own_supports
  std::vector<proto::RailSeat> support_seats;  ///< ascending x
  SparseMatrix rail_stiffness;                 ///< K_r, lower triangle [N/m]
  SparseMatrix support_stiffness;              ///< K_s: pads and ballast of the own supports, lower triangle [N/m]
  SparseMatrix support_damping;                ///< C_s: their dashpots and the rail ends', lower triangle [N s/m]
  SparseMatrix mass;                           ///< M, lower triangle [kg]
  double stiffness_damping = 0.0;              ///< b [s]
  Eigen::VectorXd weight;                      ///< of the rail, zero when switched off [N]
  SparseMatrix cells;                          ///< coupled cells x degrees of freedom
  SparseMatrix interface;                      ///< the same, then the nonlinear pads' cells of the own supports
  std::vector<InterfaceLaw> support_laws;      ///< of the latter: what they do beyond their part in K_s and C_s
  SparseMatrix support_cells;                  ///< own supports' cells x degrees of freedom of the rail
  int n_rail_dofs = 0;

  /// Rows of `interface` that belong to the own supports: normal motion of the foot against the sleeper.
  auto support_pads() const { return interface.bottomRows(static_cast<Eigen::Index>(support_laws.size())); }
  int n_dofs() const { return static_cast<int>(mass.rows()); }
  /// Degree of freedom of sleeper `support` (index into support_seats), component 0..2.
  int sleeper_dof(int support, int component) const { return n_rail_dofs + 3 * support + component; }
};

/// What a rail brings along; sizes are its own degrees of freedom.
struct RailMatrices {
  SparseMatrix stiffness;       ///< lower triangle [N/m]
  SparseMatrix mass;            ///< lower triangle [kg]
  Eigen::VectorXd end_damping;  ///< diagonal: dashpots on the end faces, and the absorbing layers' [N s/m]
  Eigen::VectorXd weight;       ///< [N]
};

/// Element boundaries along x: n_bays bays about x = 0 and half a bay more at each end in equal elements, a whole
/// number of them to a bay; beyond, the absorbing layers, each bay of them in equal elements too.
struct RailPlanes {
  std::vector<double> x;  ///< ascending [m]
  int per_bay;
  double element_length;  ///< of the refined part [m]
  int n_layer = 0;        ///< elements of the absorbing layer at each end

  double fine_begin() const { return x[n_layer]; }               ///< [m]
  double fine_end() const { return x[x.size() - 1 - n_layer]; }  ///< [m]
};
/// `layer_element_length`: largest in the layers [m].
RailPlanes rail_planes(const FemSettings& settings, double layer_element_length);

/// Mass-proportional damping of rail and sleepers at x [1/s]: grows with the cube of the depth in an absorbing layer,
/// so that a wave meets no step in it; zero in the refined part.
double layer_damping(const FemSettings& settings, double x);

/// Throws proto::Error (config) for a rail seat that is not at a multiple of the sleeper spacing, at a foot that is not
/// at z = 0, at different y, or beyond the rail.
void check_seats(const FemSettings& settings, const std::vector<proto::RailSeat>& seats);

/// Joins the rail with pads, sleepers and ballast of the seats that the partner does not carry, and with the interface.
/// A seat stands at every multiple of the sleeper spacing.
TrackSystem assemble_track(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner,
                           const RailKinematics& rail, RailMatrices matrices);

/// Damping per area rho c of the end faces along x, y, z [N s/m3]: c of the longitudinal wave along x, the phase speed
/// of the Euler-Bernoulli bending wave at the stated frequency across. It absorbs that frequency's transverse force,
/// not its moment. Zero when switched off.
Eigen::Vector3d end_impedance(const FemSettings& settings, const SectionProperties& section);

}  // namespace fem
