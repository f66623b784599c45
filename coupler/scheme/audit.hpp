// The interface audit: does the work that leaves one side arrive on the other, and does the momentum?
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "coupler/scheme/window_record.hpp"
#include "proto/result/state_archive.hpp"

namespace coupler {

/// Interface defects of one window; one value per seat, cell and seat axis.
struct WindowAudit {
  std::vector<double> work_rail;        ///< W_rail = -f_used (u_n+1 - u_n) [J]
  std::vector<double> work_pad;         ///< W_pad of the sub-steps along the same path [J]
  std::vector<double> energy_defect;    ///< D = W_rail + W_pad: energy created at the interface [J]
  std::vector<double> momentum_defect;  ///< P = H f_used - I [N s]
  double energy_defect_sum = 0.0;       ///< sum of D over all values and all windows so far [J]
};

/// Sums the defects of a run. Source of the figures: coupler/README.md "Audit".
class Audit {
 public:
  /// `n_cells[s]`: number of cells of seat s. `window_s`: window length [s].
  Audit(std::vector<std::size_t> n_cells, double window_s);

  /// Defects of one more window.
  WindowAudit add(const WindowRecord& record);

  /// The sums.
  void exchange(proto::StateArchive& archive);

  /// max over n of |sum of D up to window n|, over the sum of |W_rail| of all windows and seats; 0 before any work.
  double energy_defect_relative() const;

  /// max over n and seat of |sum of P up to window n|, over the largest seat's sum of |I|; P and I are a seat's
  /// resultant force impulses (vectors, summed over its cells). 0 before any impulse.
  double momentum_defect_relative() const;

 private:
  struct Seat {
    double work = 0.0;                      ///< sum of |W_rail|
    double impulse = 0.0;                   ///< sum of |I|
    double momentum_defect[3] = {0, 0, 0};  ///< sum of P
  };
  void add_seat(Seat& seat, std::size_t first, std::size_t n_cells, const WindowAudit& defects,
                const std::vector<double>& impulse);

  std::vector<std::size_t> n_cells_;
  double window_s_;
  std::vector<Seat> seats_;
  double energy_defect_ = 0.0, largest_energy_defect_ = 0.0, largest_momentum_defect_ = 0.0;
};

}  // namespace coupler
