#include "fem_solver/assembly/rail_system.hpp"

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace fem {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;
constexpr double pi = 3.14159265358979323846;
constexpr double gravity = 9.81;  // [m/s2]

[[noreturn]] void refuse(const proto::RailSeat& seat, const std::string& problem, const std::string& advice) {
  throw proto::Error(proto::ExitCode::config, "rail seat '" + seat.name + "' " + problem, "[[rail_seat]] origin_m",
                     advice);
}

void check_seats(const FemSettings& s, const std::vector<proto::RailSeat>& seats) {
  for (const auto& seat : seats) {
    const double bay = seat.origin[0] / s.sleeper_spacing;
    if (std::abs(bay - std::round(bay)) > 1e-6)
      refuse(seat, "does not lie at a multiple of the sleeper spacing", "move it or change track.sleeper_spacing_m");
    if (std::abs(bay) > s.n_bays / 2 + 1e-6) refuse(seat, "lies beyond the rail", "raise fem.n_bays");
    if (std::abs(seat.origin[2]) > 1e-9) refuse(seat, "is not at z = 0, the rail foot's bottom", "set z to 0");
    if (std::abs(seat.origin[1] - seats.front().origin[1]) > 1e-9)
      refuse(seat, "is not in line with the first seat", "give all seats the same y");
  }
}

std::vector<double> mesh_planes(double spacing, int n_bays, int per_bay) {
  const double length = spacing / per_bay;
  const int half = n_bays / 2 * per_bay + (per_bay + 1) / 2;
  std::vector<double> x;
  for (int i = -half; i <= half; ++i) x.push_back(i * length);
  return x;
}

// Seats of the case keep their pads on the own supports too; the others take the pad of the settings.
std::vector<proto::RailSeat> support_seats(const FemSettings& s, const std::vector<proto::RailSeat>& seats,
                                           SeatOwner owner) {
  std::vector<proto::RailSeat> supports;
  for (int i = -s.n_bays / 2; i <= s.n_bays / 2; ++i) {
    const double x = i * s.sleeper_spacing;
    const auto same =
        std::find_if(seats.begin(), seats.end(), [&](const auto& q) { return std::abs(q.origin[0] - x) < 1e-6; });
    if (same != seats.end()) {
      if (owner == SeatOwner::own_supports) supports.push_back(*same);
      continue;
    }
    proto::RailSeat seat;
    seat.name = "support " + std::to_string(i);
    seat.origin = {x, seats.front().origin[1], 0.0};
    seat.axes.setIdentity();
    seat.half_lengths = s.support.pad_half_lengths;
    seat.cells = s.support.pad_cells;
    seat.stiffness = s.support.pad_stiffness;
    seat.damping = s.support.pad_damping;
    supports.push_back(seat);
  }
  return supports;
}

// value' * weight * value for the rows (foot cell value - sleeper component along the seat axis).
void add_pads(const RailSystem& system, Triplets& stiffness, Triplets& damping) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor> rows = system.support_cells;
  int value = 0;
  for (std::size_t i = 0; i < system.support_seats.size(); ++i) {
    const auto& seat = system.support_seats[i];
    for (int k = 0; k < 3 * seat.n_cells(); ++k, ++value) {
      std::vector<std::pair<int, double>> row;
      for (decltype(rows)::InnerIterator it(rows, value); it; ++it) row.emplace_back(it.col(), it.value());
      for (int c = 0; c < 3; ++c)
        if (seat.axes(c, k % 3) != 0.0) row.emplace_back(system.sleeper_dof(i, c), -seat.axes(c, k % 3));
      const auto law = seat.cell_law(k % 3);
      for (const auto& [a, wa] : row)
        for (const auto& [b, wb] : row)
          if (b <= a)
            stiffness.emplace_back(a, b, law.stiffness * wa * wb), damping.emplace_back(a, b, law.damping * wa * wb);
    }
  }
}

void add_ballast(const RailSystem& system, const SupportSettings& s, Triplets& stiffness, Triplets& damping) {
  for (std::size_t i = 0; i < system.support_seats.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const int dof = system.sleeper_dof(i, c);
      stiffness.emplace_back(dof, dof, s.ballast_stiffness[c]);
      damping.emplace_back(dof, dof, s.ballast_damping[c]);
    }
}

// Traction -rho c v on the end faces: c of the longitudinal wave along x, the phase speed of the Euler-Bernoulli
// bending wave at the stated frequency across. It absorbs that frequency's transverse force, not its moment.
void add_end_dashpots(const RailSystem& system, const FemSettings& s, Triplets& damping) {
  if (s.end_dashpot_frequency == 0.0) return;
  const SectionProperties p = system.mesh->section().properties();
  const double omega = 2 * pi * s.end_dashpot_frequency;
  const auto bending = [&](double inertia) {
    return std::pow(s.material.young * inertia * omega * omega / (s.material.density * p.area), 0.25);
  };
  const double speed[3] = {std::sqrt(s.material.young / s.material.density), bending(p.inertia_lateral),
                           bending(p.inertia_vertical)};
  const Eigen::VectorXd areas = system.mesh->end_face_areas();
  for (int n = 0; n < system.mesh->n_nodes(); ++n)
    for (int c = 0; c < 3 && areas[n] > 0; ++c)
      damping.emplace_back(3 * n + c, 3 * n + c, s.material.density * speed[c] * areas[n]);
}

SparseMatrix from(const Triplets& entries, int n) {
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

RailSystem build_rail_system(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner) {
  check_seats(settings, seats);
  RailSystem system;
  system.planes_per_bay = static_cast<int>(std::ceil(settings.sleeper_spacing / settings.element_length - 1e-9));
  system.element_length = settings.sleeper_spacing / system.planes_per_bay;
  system.mesh = std::make_unique<RailMesh>(
      rail_section(settings.profile), mesh_planes(settings.sleeper_spacing, settings.n_bays, system.planes_per_bay),
      seats.front().origin[1]);
  if (owner == SeatOwner::partner) system.coupled_seats = seats;
  system.support_seats = support_seats(settings, seats, owner);
  system.cells = CellOperator(*system.mesh, system.coupled_seats).matrix();
  system.support_cells = CellOperator(*system.mesh, system.support_seats).matrix();

  const int n_mesh = system.mesh->n_dofs(), n = n_mesh + 3 * static_cast<int>(system.support_seats.size());
  system.cells.conservativeResize(system.cells.rows(), n);
  system.mass.resize(n);
  const Eigen::VectorXd volumes = system.mesh->node_volumes();
  for (int i = 0; i < n_mesh; ++i) system.mass[i] = settings.material.density * volumes[i / 3];
  system.mass.tail(n - n_mesh).setConstant(settings.support.sleeper_mass);
  system.weight = Eigen::VectorXd::Zero(n);
  // Sleepers are measured from their own state of rest, as the coupled ones are: only the rail has weight here.
  if (settings.gravity)
    for (int i = 2; i < n_mesh; i += 3) system.weight[i] = -gravity * system.mass[i];

  Triplets stiffness, damping;
  add_pads(system, stiffness, damping);
  add_ballast(system, settings.support, stiffness, damping);
  add_end_dashpots(system, settings, damping);
  system.support_stiffness = from(stiffness, n);
  system.support_damping = from(damping, n);
  system.rail_stiffness = system.mesh->stiffness(settings.material);
  system.rail_stiffness.conservativeResize(n, n);
  system.stiffness_damping = settings.loss_factor / (2 * pi * settings.loss_factor_frequency);
  return system;
}

}  // namespace fem
