// The few unknowns of a window: pad cells with cut-off and one wheel contact, condensed on the interface.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fem_solver/contact/wheel_contact.hpp"
#include "fem_solver/model/interface_law.hpp"

namespace fem {

/// Everything is affine in the pad forces f_used and the contact force F except the two laws:
///
///     w    = free_velocity - compliance f_used - contact_column F          mean velocity of the cells
///     f    = law(gap_0 + time_factor w, w - sleeper_velocity)              f_used = f - carry
///     delta = approach_0 - contact_column' (time_factor f_used) - contact_slope F,   F = contact_law(delta)
///
/// `gap_0` and `approach_0` hold what does not depend on this window's unknowns.
struct InterfaceProblem {
  std::vector<InterfaceLaw> laws;
  Eigen::VectorXd gap_0;             ///< [m]
  Eigen::VectorXd free_velocity;     ///< [m/s], zero in statics
  Eigen::VectorXd sleeper_velocity;  ///< [m/s]
  Eigen::VectorXd carry;             ///< [N]
  Eigen::MatrixXd compliance;        ///< symmetric, interface velocity per force [m/(N s)]
  double time_factor = 0.0;          ///< H/2; statics: 1 with compliance as a displacement and no rates
  double rate_factor = 1.0;          ///< 1; statics: 0
  Eigen::VectorXd contact_column;    ///< velocity of the cells per contact force [m/(N s)]
  double approach_0 = 0.0;           ///< [m]
  double contact_slope = 0.0;        ///< total flexibility of band, wheel and indentation, minus d delta/d F [m/N]
  ContactLaw contact_law;            ///< none: the contact force is `given_contact`
  double given_contact = 0.0;        ///< [N]
};

struct InterfaceSolution {
  Eigen::VectorXd force;  ///< f before the carry [N]
  double contact = 0.0;   ///< F >= 0 [N]
  int iterations = 0;
  double approach = 0.0;  ///< delta where there is a contact law [m]
};

/// Semi-smooth Newton from `guess`, step halved while the residual grows. Converged when every residual is below
/// 1e-11 of the largest force (at least 1 N). Throws proto::Error (numerics) after 60 iterations with the residuals.
InterfaceSolution solve_interface(const InterfaceProblem& problem, const InterfaceSolution& guess, const char* where);

}  // namespace fem
