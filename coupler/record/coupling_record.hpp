// coupling.h5: everything that crossed the interface, window by window, and its audit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coupler/scheme/audit.hpp"
#include "coupler/scheme/scheme_state.hpp"
#include "coupler/scheme/window_record.hpp"
#include "proto/case/rail_seat.hpp"
#include "proto/result/time_series.hpp"

namespace coupler {

/// Writes one row at time 0 (window -1: the initial values) and one per window. Layout: coupler/README.md "Record".
class CouplingRecord {
 public:
  /// Throws proto::Error (cannot_create).
  CouplingRecord(const std::string& path, const std::vector<proto::RailSeat>& seats, double window_s,
                 const proto::Attributes& attributes);

  /// Goes on with the file that an earlier process made with the same arguments, from what its exchange() saved.
  CouplingRecord(const std::string& path, const std::vector<proto::RailSeat>& seats, double window_s,
                 const proto::Attributes& attributes, proto::StateArchive& saved);

  /// The number of rows and the running sums.
  void exchange(proto::StateArchive& archive);
  /// What was added is safe against a loss of power.
  void synchronise() { file_->synchronise(); }

  /// All functions throw proto::Error (io_error) once a write has failed.
  void add_initial(const InterfaceState& initial);
  void add(const WindowRecord& record, const WindowAudit& defects, const Audit& audit);
  void close();

 private:
  void put_moments(const std::vector<double>& values);
  void put_seats(const std::string& name, const std::vector<double>& values);

  std::vector<proto::RailSeat> seats_;
  double window_s_;
  std::vector<double> momentum_defect_sum_;
  std::uint64_t n_rows_ = 0;
  std::optional<proto::TimeSeriesFile> file_;
};

}  // namespace coupler
