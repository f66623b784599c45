#include "coupler/scheme/audit.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace coupler {
namespace {

using Vector3 = std::array<double, 3>;

double norm(const Vector3& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

void add_to(Vector3& sum, const Vector3& v) {
  for (std::size_t i = 0; i < 3; ++i) sum[i] += v[i];
}

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double ratio(double defect, double scale) {
  return scale > 0.0 ? defect / scale : 0.0;
}

}  // namespace

Audit::Audit(std::vector<AuditSeat> seats, double window_s) : seats_(std::move(seats)), window_s_(window_s) {
  state_.seats.resize(seats_.size());
}

WindowAudit Audit::add(const WindowRecord& record) {
  WindowAudit defects;
  for (std::size_t i = 0; i < record.impulse.size(); ++i) {
    const double work = -record.force_used[i] * (record.rail_displacement[i] - record.rail_displacement_begin[i]);
    defects.work_rail.push_back(work);
    defects.work_pad.push_back(record.pad_work[i]);
    defects.energy_defect.push_back(work + record.pad_work[i]);
    defects.momentum_defect.push_back(window_s_ * record.force_used[i] - record.impulse[i]);
    state_.energy_defect += defects.energy_defect.back();
  }
  state_.largest_energy_defect = std::max(state_.largest_energy_defect, std::abs(state_.energy_defect));
  std::size_t first = 0;
  for (std::size_t s = 0; s < seats_.size(); ++s) {
    add_seat(s, first, defects, record.impulse);
    first += 3 * seats_[s].arms.size();
  }
  defects.energy_defect_sum = state_.energy_defect;
  return defects;
}

void Audit::add_seat(std::size_t seat, std::size_t first, WindowAudit& defects, const std::vector<double>& impulse) {
  auto& sums = state_.seats[seat];
  double work = 0.0;
  Vector3 seat_impulse{}, moment{};
  for (std::size_t cell = 0; cell < seats_[seat].arms.size(); ++cell) {
    const std::size_t i = first + 3 * cell;
    const Vector3 defect{defects.momentum_defect[i], defects.momentum_defect[i + 1], defects.momentum_defect[i + 2]};
    work += defects.work_rail[i] + defects.work_rail[i + 1] + defects.work_rail[i + 2];
    add_to(seat_impulse, {impulse[i], impulse[i + 1], impulse[i + 2]});
    add_to(sums.momentum_defect, defect);
    add_to(moment, cross(seats_[seat].arms[cell], defect));
  }
  sums.work += std::abs(work);
  sums.impulse += norm(seat_impulse);
  add_to(sums.moment_defect, moment);
  defects.moment_defect.insert(defects.moment_defect.end(), moment.begin(), moment.end());
  state_.largest_momentum_defect = std::max(state_.largest_momentum_defect, norm(sums.momentum_defect));
  state_.largest_moment_ratio =
      std::max(state_.largest_moment_ratio, ratio(norm(sums.moment_defect), seats_[seat].half_diagonal));
}

void Audit::exchange(proto::StateArchive& archive) {
  archive("audit/energy_defect", state_.energy_defect);
  archive("audit/largest_energy_defect", state_.largest_energy_defect);
  archive("audit/largest_momentum_defect", state_.largest_momentum_defect);
  archive("audit/largest_moment_ratio", state_.largest_moment_ratio);
  for (std::size_t s = 0; s < seats_.size(); ++s) {
    const std::string seat = "audit/seat_" + std::to_string(s) + "/";
    archive(seat + "work", state_.seats[s].work);
    archive(seat + "impulse", state_.seats[s].impulse);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      archive(seat + "momentum_defect_" + std::to_string(axis), state_.seats[s].momentum_defect[axis]);
      archive(seat + "moment_defect_" + std::to_string(axis), state_.seats[s].moment_defect[axis]);
    }
  }
}

double Audit::work() const {
  double work = 0.0;
  for (const auto& seat : state_.seats) work += seat.work;
  return work;
}

double Audit::impulse() const {
  double impulse = 0.0;
  for (const auto& seat : state_.seats) impulse = std::max(impulse, seat.impulse);
  return impulse;
}

double Audit::energy_defect_relative() const {
  return ratio(state_.largest_energy_defect, work());
}

double Audit::momentum_defect_relative() const {
  return ratio(state_.largest_momentum_defect, impulse());
}

double Audit::moment_defect_relative() const {
  return ratio(state_.largest_moment_ratio, impulse());
}

}  // namespace coupler
