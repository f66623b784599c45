// Rail, supports and interface as matrices: what the time integration works with.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fem_solver/assembly/cell_operator.hpp"
#include "fem_solver/assembly/rail_mesh.hpp"
#include "fem_solver/model/settings.hpp"
#include "proto/case/rail_seat.hpp"

namespace fem {

/// Which seats the rail's own model leaves to the coupling partner.
enum class SeatOwner { partner, own_supports };

/// The semi-discrete track: degrees of freedom of the mesh first, then three translations per supporting sleeper.
///
///     M u'' + (C_s + b K_r) u' + (K_r + K_s) u = load
///
/// Immutable after build. Symmetric matrices are stored as their lower triangle.
struct RailSystem {
  std::unique_ptr<RailMesh> mesh;
  std::vector<proto::RailSeat> coupled_seats;  ///< in the order of the case; empty with SeatOwner::own_supports
  std::vector<proto::RailSeat> support_seats;  ///< ascending x
  SparseMatrix rail_stiffness;                 ///< K_r, lower triangle [N/m]
  SparseMatrix support_stiffness;              ///< K_s: pads and ballast of the own supports, lower triangle [N/m]
  SparseMatrix support_damping;                ///< C_s: their dashpots and the rail ends', lower triangle [N s/m]
  Eigen::VectorXd mass;                        ///< diagonal of M [kg]
  double stiffness_damping = 0.0;              ///< b [s]
  Eigen::VectorXd weight;                      ///< of the rail, zero when switched off [N]
  SparseMatrix cells;                          ///< coupled cells x degrees of freedom
  SparseMatrix support_cells;                  ///< own supports' cells x degrees of freedom of the mesh
  double element_length = 0.0;                 ///< [m]
  int planes_per_bay = 0;                      ///< elements along x in one bay

  int n_dofs() const { return static_cast<int>(mass.size()); }
  /// Degree of freedom of sleeper `support` (index into support_seats), component 0..2.
  int sleeper_dof(int support, int component) const { return mesh->n_dofs() + 3 * support + component; }
};

/// Builds the track of a case. The rail spans n_bays bays about x = 0 and half a bay more at each end; a seat stands at
/// every multiple of the sleeper spacing. Throws proto::Error (config) for a rail seat that is not at such a multiple,
/// at a foot that is not at z = 0, at different y, or beyond the rail.
RailSystem build_rail_system(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner);

}  // namespace fem
