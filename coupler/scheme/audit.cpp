#include "coupler/scheme/audit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace coupler {
namespace {

double norm(const double (&v)[3]) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

}  // namespace

Audit::Audit(std::vector<std::size_t> n_cells, double window_s)
    : n_cells_(std::move(n_cells)), window_s_(window_s), seats_(n_cells_.size()) {}

WindowAudit Audit::add(const WindowRecord& record) {
  WindowAudit defects;
  for (std::size_t i = 0; i < record.impulse.size(); ++i) {
    const double work = -record.force_used[i] * (record.rail_displacement[i] - record.rail_displacement_begin[i]);
    defects.work_rail.push_back(work);
    defects.work_pad.push_back(record.pad_work[i]);
    defects.energy_defect.push_back(work + record.pad_work[i]);
    defects.momentum_defect.push_back(window_s_ * record.force_used[i] - record.impulse[i]);
    energy_defect_ += defects.energy_defect.back();
  }
  largest_energy_defect_ = std::max(largest_energy_defect_, std::abs(energy_defect_));
  std::size_t first = 0;
  for (std::size_t s = 0; s < seats_.size(); ++s) {
    add_seat(seats_[s], first, n_cells_[s], defects, record.impulse);
    first += 3 * n_cells_[s];
  }
  defects.energy_defect_sum = energy_defect_;
  return defects;
}

void Audit::add_seat(Seat& seat, std::size_t first, std::size_t n_cells, const WindowAudit& defects,
                     const std::vector<double>& impulse) {
  double work = 0.0, seat_impulse[3] = {0, 0, 0};
  for (std::size_t i = first; i < first + 3 * n_cells; ++i) {
    const std::size_t axis = (i - first) % 3;
    work += defects.work_rail[i];
    seat_impulse[axis] += impulse[i];
    seat.momentum_defect[axis] += defects.momentum_defect[i];
  }
  seat.work += std::abs(work);
  seat.impulse += norm(seat_impulse);
  largest_momentum_defect_ = std::max(largest_momentum_defect_, norm(seat.momentum_defect));
}

void Audit::exchange(proto::StateArchive& archive) {
  archive("audit/energy_defect", energy_defect_);
  archive("audit/largest_energy_defect", largest_energy_defect_);
  archive("audit/largest_momentum_defect", largest_momentum_defect_);
  for (std::size_t s = 0; s < seats_.size(); ++s) {
    const std::string seat = "audit/seat_" + std::to_string(s) + "/";
    archive(seat + "work", seats_[s].work);
    archive(seat + "impulse", seats_[s].impulse);
    for (int axis = 0; axis < 3; ++axis)
      archive(seat + "momentum_defect_" + std::to_string(axis), seats_[s].momentum_defect[axis]);
  }
}

double Audit::energy_defect_relative() const {
  double work = 0.0;
  for (const auto& seat : seats_) work += seat.work;
  return work > 0.0 ? largest_energy_defect_ / work : 0.0;
}

double Audit::momentum_defect_relative() const {
  double impulse = 0.0;
  for (const auto& seat : seats_) impulse = std::max(impulse, seat.impulse);
  return impulse > 0.0 ? largest_momentum_defect_ / impulse : 0.0;
}

}  // namespace coupler
