#include "proto/case/rail_seat.hpp"

#include <Eigen/Geometry>
#include <set>

namespace proto {
namespace {

Eigen::Vector3d vector3(const Section& section, const std::string& key, Range range = Range::any()) {
  const auto values = section.numbers(key, 3, range);
  return {values[0], values[1], values[2]};
}

Eigen::Vector3d vector3_or(const Section& section, const std::string& key, const Eigen::Vector3d& fallback) {
  return section.has(key) ? vector3(section, key) : fallback;
}

Eigen::Matrix3d read_axes(const Section& section) {
  Eigen::Matrix3d axes;
  axes.col(0) = vector3_or(section, "longitudinal_axis", Eigen::Vector3d::UnitX());
  axes.col(1) = vector3_or(section, "lateral_axis", Eigen::Vector3d::UnitY());
  axes.col(2) = axes.col(0).cross(axes.col(1));
  if (!(axes.transpose() * axes).isIdentity(1e-9))
    section.fail("lateral_axis", "the longitudinal and lateral axes are not orthonormal",
                 "give two perpendicular unit vectors");
  return axes;
}

RailSeat read_rail_seat(const Section& section) {
  RailSeat seat;
  seat.name = section.text("name");
  seat.origin = vector3(section, "origin_m");
  seat.axes = read_axes(section);
  const auto half = section.numbers("half_lengths_m", 2, Range::positive());
  seat.half_lengths = {half[0], half[1]};
  const auto cells = section.integers("cells", 2, Range::between(1, 64));
  seat.cells = {static_cast<int>(cells[0]), static_cast<int>(cells[1])};
  seat.stiffness = vector3(section, "stiffness_n_per_m", Range::not_negative());
  seat.damping = vector3(section, "damping_ns_per_m", Range::not_negative());
  seat.clip_preload = section.number_or("clip_preload_n", 0.0, Range::not_negative());
  seat.tension_cutoff = section.boolean_or("tension_cutoff", false);
  section.finish();
  return seat;
}

}  // namespace

Eigen::Vector3d RailSeat::cell_point(int index) const {
  const double s = (2.0 * (index % cells[0]) + 1.0) / cells[0] - 1.0;
  const double t = (2.0 * (index / cells[0]) + 1.0) / cells[1] - 1.0;
  return origin + axes.col(0) * (s * half_lengths[0]) + axes.col(1) * (t * half_lengths[1]);
}

PadLaw RailSeat::cell_law(int axis) const {
  const bool normal = axis == 2;
  const double share = cell_weight();
  return {stiffness[axis] * share, damping[axis] * share, normal ? clip_preload * share : 0.0,
          normal && tension_cutoff};
}

std::vector<RailSeat> read_rail_seats(const CaseFile& file) {
  std::vector<RailSeat> seats;
  std::set<std::string> names;
  for (const auto& section : file.sections("rail_seat")) {
    seats.push_back(read_rail_seat(section));
    if (!names.insert(seats.back().name).second)
      section.fail("name", "two rail seats are called '" + seats.back().name + "'", "give each a name of its own");
  }
  if (seats.empty())
    throw Error(ExitCode::config, "the case has no rail seat", file.path(), "add a [[rail_seat]] table");
  return seats;
}

std::size_t n_interface_values(const std::vector<RailSeat>& seats) {
  std::size_t n = 0;
  for (const auto& seat : seats) n += 3 * static_cast<std::size_t>(seat.n_cells());
  return n;
}

std::vector<PadLaw> interface_laws(const std::vector<RailSeat>& seats) {
  std::vector<PadLaw> laws;
  for (const auto& seat : seats)
    for (int cell = 0; cell < seat.n_cells(); ++cell)
      for (int axis = 0; axis < 3; ++axis) laws.push_back(seat.cell_law(axis));
  return laws;
}

}  // namespace proto
