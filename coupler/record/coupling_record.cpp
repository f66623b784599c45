#include "coupler/record/coupling_record.hpp"

namespace coupler {
namespace {

struct SeatColumn {
  const char* name;
  const char* unit;
  const char* description;
};

constexpr SeatColumn seat_columns[] = {
    {"rail_displacement", "m", "rail foot at the window's end, seat axes"},
    {"rail_velocity", "m/s", "rail foot at the window's end, seat axes"},
    {"sleeper_displacement", "m", "sleeper at the window's end, seat axes"},
    {"sleeper_velocity", "m/s", "sleeper at the window's end, seat axes"},
    {"force_robin", "N", "the rail side's pad force before the carry (equal to force_used without Robin)"},
    {"force_used", "N", "force on the sleeper whose reaction loaded the rail, window mean"},
    {"impulse", "N s", "of the pad force on the sleeper over the window"},
    {"work_rail", "J", "W_rail = -force_used . (u_n+1 - u_n)"},
    {"work_pad", "J", "W_pad: work of the pad force along the rail's path in the sub-steps"},
    {"energy_defect", "J", "D = W_rail + W_pad: energy created at the interface in the window"},
    {"momentum_defect", "N s", "P = H force_used - impulse"},
    {"momentum_defect_sum", "N s", "sum of P since time 0"},
};

constexpr const char* moment_text = "moment of P about the seat's origin, summed over the cells, seat axes";

std::vector<proto::Column> columns(const std::vector<proto::RailSeat>& seats) {
  std::vector<proto::Column> result{
      {"window", "1", "window number; -1: the initial values", {}},
      {"time", "s", "at the window's end", {}},
      {"energy_defect_sum", "J", "sum of D over all values since time 0", {}},
      {"energy_defect_relative", "1", "largest |sum of D| so far over the sum of |W_rail| so far", {}},
      {"momentum_defect_relative", "1", "largest |sum of P| so far over the largest seat's sum of |I| so far", {}},
      {"moment_defect_relative", "1", "the same of moments about the seat, over that times the half-diagonal", {}},
      {"solves", "1", "passes through the window", {}},
      {"converged", "1", "0: an iteration that was accepted at its limit", {}},
      {"sub_cycles", "1", "steps of qdem in the window", {}},
      {"qdem_compute", "s", "wall time qdem computed in the window", {}},
      {"fem_compute", "s", "wall time fem computed in the window", {}},
      {"window_begin", "s", "wall time since the march began, or was resumed: the window's first request", {}},
      {"window_end", "s", "the same of its last result", {}},
  };
  for (const auto& seat : seats) {
    result.push_back({"seats/" + seat.name + "/moment_defect", "N m s", moment_text, {3}});
    for (const auto& column : seat_columns)
      result.push_back({"seats/" + seat.name + "/" + column.name,
                        column.unit,
                        column.description,
                        {static_cast<std::size_t>(seat.n_cells()), 3}});
  }
  return result;
}

}  // namespace

CouplingRecord::CouplingRecord(const std::string& path, const std::vector<proto::RailSeat>& seats, double window_s,
                               const proto::Attributes& attributes)
    : seats_(seats),
      window_s_(window_s),
      momentum_defect_sum_(proto::n_interface_values(seats), 0.0),
      file_(proto::TimeSeriesFile::create(path, columns(seats), attributes)) {}

CouplingRecord::CouplingRecord(const std::string& path, const std::vector<proto::RailSeat>& seats, double window_s,
                               const proto::Attributes& attributes, proto::StateArchive& saved)
    : seats_(seats), window_s_(window_s) {
  exchange(saved);
  saved.expect_length("record/momentum_defect_sum", momentum_defect_sum_.size(), proto::n_interface_values(seats));
  file_ = proto::TimeSeriesFile::resume(path, n_rows_, columns(seats), attributes);
}

void CouplingRecord::exchange(proto::StateArchive& archive) {
  archive("record/rows", n_rows_);
  archive("record/momentum_defect_sum", momentum_defect_sum_);
}

void CouplingRecord::put_seats(const std::string& name, const std::vector<double>& values) {
  std::size_t first = 0;
  for (const auto& seat : seats_) {
    const std::size_t n = 3 * static_cast<std::size_t>(seat.n_cells());
    file_->put("seats/" + seat.name + "/" + name, proto::Span<const double>(values.data() + first, n));
    first += n;
  }
}

void CouplingRecord::put_moments(const std::vector<double>& values) {
  for (std::size_t s = 0; s < seats_.size(); ++s)
    file_->put("seats/" + seats_[s].name + "/moment_defect", proto::Span<const double>(values.data() + 3 * s, 3));
}

void CouplingRecord::add_initial(const InterfaceState& initial) {
  const std::vector<double> zero(momentum_defect_sum_.size(), 0.0);
  file_->put("window", -1.0);
  for (const char* name : {"time", "energy_defect_sum", "energy_defect_relative", "momentum_defect_relative",
                           "moment_defect_relative", "solves", "sub_cycles", "qdem_compute", "fem_compute",
                           "window_begin", "window_end"})
    file_->put(name, 0.0);
  file_->put("converged", 1.0);
  for (const auto& column : seat_columns) put_seats(column.name, zero);
  put_moments(std::vector<double>(3 * seats_.size(), 0.0));
  put_seats("rail_displacement", initial.rail_displacement);
  put_seats("rail_velocity", initial.rail_velocity);
  put_seats("sleeper_displacement", initial.sleeper_displacement);
  put_seats("sleeper_velocity", initial.sleeper_velocity);
  file_->end_row();
  ++n_rows_;
  file_->commit();  // from here on the file can be opened whatever happens
}

void CouplingRecord::add(const WindowRecord& record, const WindowAudit& defects, const Audit& audit) {
  for (std::size_t i = 0; i < momentum_defect_sum_.size(); ++i) momentum_defect_sum_[i] += defects.momentum_defect[i];
  file_->put("window", static_cast<double>(record.window));
  file_->put("time", static_cast<double>(record.window + 1) * window_s_);
  file_->put("energy_defect_sum", defects.energy_defect_sum);
  file_->put("energy_defect_relative", audit.energy_defect_relative());
  file_->put("momentum_defect_relative", audit.momentum_defect_relative());
  file_->put("moment_defect_relative", audit.moment_defect_relative());
  file_->put("solves", record.solves);
  file_->put("converged", record.converged ? 1.0 : 0.0);
  file_->put("sub_cycles", static_cast<double>(record.sub_cycles));
  file_->put("qdem_compute", record.explicit_compute_s);
  file_->put("fem_compute", record.implicit_compute_s);
  file_->put("window_begin", record.begin_s);
  file_->put("window_end", record.end_s);
  put_seats("rail_displacement", record.rail_displacement);
  put_seats("rail_velocity", record.rail_velocity);
  put_seats("sleeper_displacement", record.sleeper_displacement);
  put_seats("sleeper_velocity", record.sleeper_velocity);
  put_seats("force_robin", record.force_robin);
  put_seats("force_used", record.force_used);
  put_seats("impulse", record.impulse);
  put_seats("work_rail", defects.work_rail);
  put_seats("work_pad", defects.work_pad);
  put_seats("energy_defect", defects.energy_defect);
  put_seats("momentum_defect", defects.momentum_defect);
  put_moments(defects.moment_defect);
  put_seats("momentum_defect_sum", momentum_defect_sum_);
  file_->end_row();
  ++n_rows_;
}

void CouplingRecord::close() {
  file_->close();
}

}  // namespace coupler
