// What crossed the interface in one window.
#pragma once

#include <cstdint>
#include <vector>

#include "proto/wire/messages.hpp"

namespace coupler {

/// One value per seat, cell and seat axis in every vector, in this order.
struct WindowRecord {
  proto::Phase phase = proto::Phase::march;
  std::int64_t window = 0;
  std::uint32_t sub_cycles = 1;                 ///< of the explicit side
  std::vector<double> rail_displacement_begin;  ///< u at t_n [m]
  std::vector<double> rail_displacement;        ///< u at t_n+1 [m]
  std::vector<double> rail_velocity;            ///< u' at t_n+1 [m/s]
  std::vector<double> sleeper_displacement;     ///< x at t_n+1 [m]
  std::vector<double> sleeper_velocity;         ///< x' at t_n+1 [m/s]
  std::vector<double> force_robin;  ///< rail side's pad force before the carry; force_used without Robin [N]
  std::vector<double> force_used;   ///< the force whose reaction loaded the rail [N]
  std::vector<double>
      force_law;                ///< Robin: the registered law at the motion that force_robin belongs to; else empty [N]
  std::vector<double> impulse;  ///< of the pad force on the sleeper [N s]
  std::vector<double> pad_work;  ///< of the pad force along the rail's path, in the sub-steps [J]
  int solves = 1;                ///< of the sleeper's side: passes through the window
  bool converged = true;         ///< false: an iteration that was accepted at its limit
  double force_residual = 0.0;   ///< of an iteration: last residual of the mean force over its running scale [-]
  double contraction = 0.0;      ///< of an iteration or a corrector: last residual over the one before; 0: none [-]
  double implicit_compute_s = 0.0, explicit_compute_s = 0.0;
  double begin_s = 0.0, end_s = 0.0;  ///< of the march, by the coupler's clock since it began [s]
  double implicit_residual = 0.0, explicit_residual = 0.0;  ///< Result.residual; 0 where none was given [-]
};

}  // namespace coupler
