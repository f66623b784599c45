// The interface audit: does the work that leaves one side arrive on the other, and do momentum and moment?
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "coupler/scheme/window_record.hpp"
#include "proto/result/state_archive.hpp"

namespace coupler {

/// Cells of one seat as the audit sees them.
struct AuditSeat {
  std::vector<std::array<double, 3>> arms;  ///< cell point minus the seat's origin, in seat axes [m]
  double half_diagonal = 0.0;               ///< of the pad: the length that moments are compared by [m]
};

/// Interface defects of one window; one value per seat, cell and seat axis.
struct WindowAudit {
  std::vector<double> work_rail;        ///< W_rail = -f_used (u_n+1 - u_n) [J]
  std::vector<double> work_pad;         ///< W_pad of the sub-steps along the same path [J]
  std::vector<double> energy_defect;    ///< D = W_rail + W_pad: energy created at the interface [J]
  std::vector<double> momentum_defect;  ///< P = H f_used - I [N s]
  std::vector<double> moment_defect;    ///< sum of arm x P over the cells; per seat and seat axis [N m s]
  double energy_defect_sum = 0.0;       ///< sum of D over all values and all windows so far [J]
};

/// Sums over the windows of one seat.
struct SeatSums {
  double work = 0.0;                           ///< of |W_rail| [J]
  double impulse = 0.0;                        ///< of |I| [N s]
  std::array<double, 3> momentum_defect = {};  ///< of P [N s]
  std::array<double, 3> moment_defect = {};    ///< of its moment about the seat's origin [N m s]
};

/// All that an audit remembers.
struct AuditState {
  std::vector<SeatSums> seats;
  double energy_defect = 0.0;          ///< sum of D [J]
  double largest_energy_defect = 0.0;  ///< of its magnitude so far [J]
  double largest_momentum_defect = 0.0,
         largest_moment_ratio = 0.0;  ///< likewise [N s]; moment over half-diagonal [N s]
};

/// Sums the defects of a run. Source of the figures: coupler/README.md "Audit".
class Audit {
 public:
  /// `window_s`: window length [s].
  Audit(std::vector<AuditSeat> seats, double window_s);

  /// Defects of one more window.
  WindowAudit add(const WindowRecord& record);

  double work() const;     ///< sum of |W_rail| over windows and seats so far [J]
  double impulse() const;  ///< largest seat's sum of |I| so far [N s]

  /// max over n of |sum of D up to window n| over work(); 0 before any work.
  double energy_defect_relative() const;

  /// max over n and seat of |sum of P up to window n| over impulse(); P and I are a seat's resultant force impulses
  /// (vectors, summed over its cells). 0 before any impulse.
  double momentum_defect_relative() const;

  /// max over n and seat of |sum of the moment of P up to window n| over impulse() times the seat's half-diagonal.
  double moment_defect_relative() const;

  /// The sums.
  void exchange(proto::StateArchive& archive);

 private:
  /// Takes the seat whose first interface value is `first`.
  void add_seat(std::size_t seat, std::size_t first, WindowAudit& defects, const std::vector<double>& impulse);

  std::vector<AuditSeat> seats_;
  double window_s_;
  AuditState state_;
};

}  // namespace coupler
