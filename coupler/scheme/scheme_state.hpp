// Everything a coupling scheme remembers from one window to the next, as plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "proto/result/state_archive.hpp"

namespace coupler {

/// Interface values at one instant.
struct InterfaceState {
  std::vector<double> rail_displacement, rail_velocity;        ///< [m], [m/s]
  std::vector<double> sleeper_displacement, sleeper_velocity;  ///< [m], [m/s]
};

/// Difference of two successive iterates' residuals, and of the forces they led to [N].
struct SecantColumn {
  std::vector<double> residual, image;
};

/// Memory of the acceleration of an implicit scheme; coupler/scheme/acceleration.hpp.
struct AccelerationState {
  std::vector<double> residual, image;        ///< of the iterate before, in this window; empty in a window's first [N]
  double relaxation = 0.0;                    ///< of the last step; 0 before the first
  std::deque<SecantColumn> columns;           ///< newest first
  std::deque<std::size_t> columns_of_window;  ///< how many of them each window gave, newest first; this window's first
};

/// Memory of the schemes for rigid joints; coupler/scheme/dual_schur.hpp. Matrices are [n][n], row by row.
struct JointState {
  std::vector<double> force;             ///< on the sleeper at t_n [N]; empty before the operators were probed
  std::vector<double> rail_operator;     ///< velocity of the rail at t_n+1 per force on the sleeper at t_n+1 [m/(N s)]
  std::vector<double> sleeper_operator;  ///< the sleeper's likewise
};

/// One value per seat, cell and seat axis in every vector of interface values. Every scheme keeps the histories that
/// the others would need, so that a run can go on with another one.
struct SchemeState {
  InterfaceState interface;
  bool rail_known = false;                   ///< false until the rail's displacement was heard for the first time
  std::uint32_t sub_cycles = 1;              ///< of the next window
  std::vector<double> sleeper_acceleration;  ///< window mean of the last window [m/s^2]
  std::vector<double> force_carry;           ///< raw defect of the last window over H [N]
  std::vector<double> force_mean;            ///< mean pad force of the last window [N]
  std::vector<double> force_mean_before;     ///< of the one before [N]
  double force_scale = 0.0;                  ///< largest norm of the mean force so far [N]
  double displacement_scale = 0.0;           ///< largest norm of the rail's displacement so far [m]
  AccelerationState acceleration;
  JointState joint;

  /// Between windows, for `n_values` interface values.
  void exchange(proto::StateArchive& archive, std::size_t n_values);
};

}  // namespace coupler
