// coupling.h5: everything that crossed the interface, window by window, and its audit.
#pragma once

#include <string>
#include <vector>

#include "coupler/scheme/audit.hpp"
#include "coupler/scheme/window_record.hpp"
#include "coupler/scheme/window_scheme.hpp"
#include "proto/case/rail_seat.hpp"
#include "proto/result/time_series.hpp"

namespace coupler {

/// Writes one row at time 0 (window -1: the initial values) and one per window. Layout: coupler/README.md "Record".
class CouplingRecord {
 public:
  /// Throws proto::Error (cannot_create).
  CouplingRecord(const std::string& path, const std::vector<proto::RailSeat>& seats, double window_s,
                 const proto::Attributes& attributes);

  /// All functions throw proto::Error (io_error) once a write has failed.
  void add_initial(const InterfaceState& initial);
  void add(const WindowRecord& record, const WindowAudit& audit);
  void close();

 private:
  void put_seats(const std::string& name, const std::vector<double>& values);

  std::vector<proto::RailSeat> seats_;
  double window_s_;
  std::vector<double> momentum_defect_sum_;
  proto::TimeSeriesFile file_;
};

}  // namespace coupler
