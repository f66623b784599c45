#include "fem_solver/assembly/track_system.hpp"

#include <algorithm>
#include <cmath>

#include "fem_solver/assembly/cell_operator.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;
constexpr double pi = 3.14159265358979323846;

[[noreturn]] void refuse(const proto::RailSeat& seat, const std::string& problem, const std::string& advice) {
  throw proto::Error(proto::ExitCode::config, "rail seat '" + seat.name + "' " + problem, "[[rail_seat]] origin_m",
                     advice);
}

// Seats of the case keep their pads on the own supports too; the others take the pad of the settings.
std::vector<proto::RailSeat> support_seats(const FemSettings& s, const std::vector<proto::RailSeat>& seats,
                                           SeatOwner owner) {
  std::vector<proto::RailSeat> supports;
  const int last = s.n_bays / 2 + s.end_layer_bays;
  for (int i = -last; i <= last; ++i) {
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
void add_pads(const TrackSystem& system, Triplets& stiffness, Triplets& damping) {
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

void add_ballast(const TrackSystem& system, const FemSettings& settings, Triplets& stiffness, Triplets& damping) {
  const SupportSettings& s = settings.support;
  for (std::size_t i = 0; i < system.support_seats.size(); ++i) {
    const double layer = s.sleeper_mass * layer_damping(settings, system.support_seats[i].origin[0]);
    for (int c = 0; c < 3; ++c) {
      const int dof = system.sleeper_dof(i, c);
      stiffness.emplace_back(dof, dof, s.ballast_stiffness[c]);
      damping.emplace_back(dof, dof, s.ballast_damping[c] + layer);
    }
  }
}

// Rows of the normal motion of the supports' pad cells against their sleepers, below the coupled cells.
void add_nonlinear_pads(TrackSystem& system, const SupportSettings& s) {
  Triplets entries;
  const auto add_block = [&](const SparseMatrix& block) {
    for (int column = 0; column < block.outerSize(); ++column)
      for (SparseMatrix::InnerIterator it(block, column); it; ++it)
        entries.emplace_back(it.row(), it.col(), it.value());
  };
  add_block(system.cells);
  int row = static_cast<int>(system.cells.rows()), value = 2;
  const Eigen::SparseMatrix<double, Eigen::RowMajor> foot = system.support_cells;
  for (std::size_t i = 0; i < system.support_seats.size() && !s.linear_pads(); ++i) {
    const auto& seat = system.support_seats[i];
    for (int cell = 0; cell < seat.n_cells(); ++cell, ++row, value += 3) {
      for (decltype(foot)::InnerIterator it(foot, value); it; ++it) entries.emplace_back(row, it.col(), it.value());
      for (int c = 0; c < 3; ++c)
        entries.emplace_back(row, system.sleeper_dof(static_cast<int>(i), c), -seat.axes(c, 2));
      proto::PadLaw pad = seat.cell_law(2);
      pad.tension_cutoff = s.pad_tension_cutoff, pad.preload = s.pad_clip_preload * seat.cell_weight();
      const double second = s.pad_second_stiffness * seat.cell_weight();
      system.support_laws.push_back({pad, s.pad_second_begin, std::max(0.0, second - pad.stiffness), true});
    }
  }
  system.interface.resize(row, system.cells.cols());
  system.interface.setFromTriplets(entries.begin(), entries.end());
}

SparseMatrix from(const Triplets& entries, int n) {
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

RailPlanes rail_planes(const FemSettings& s, double layer_element_length) {
  const auto elements = [&](double length) { return static_cast<int>(std::ceil(s.sleeper_spacing / length - 1e-9)); };
  const int per_bay = elements(s.element_length);
  RailPlanes planes{{}, per_bay, s.sleeper_spacing / per_bay};
  const int half = s.n_bays / 2 * per_bay + (per_bay + 1) / 2;
  const int per_layer_bay = elements(layer_element_length);
  const double layer_length = s.sleeper_spacing / per_layer_bay;
  planes.n_layer = s.end_layer_bays * per_layer_bay;
  for (int i = planes.n_layer; i > 0; --i) planes.x.push_back(-half * planes.element_length - i * layer_length);
  for (int i = -half; i <= half; ++i) planes.x.push_back(i * planes.element_length);
  for (int i = 1; i <= planes.n_layer; ++i) planes.x.push_back(half * planes.element_length + i * layer_length);
  return planes;
}

double layer_damping(const FemSettings& s, double x) {
  const double depth = std::abs(x) - rail_planes(s, s.sleeper_spacing).fine_end();
  if (s.end_layer_bays == 0 || depth <= 0.0) return 0.0;
  const double share = depth / (s.end_layer_bays * s.sleeper_spacing);
  return s.end_layer_damping * share * share * share;
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

Eigen::Vector3d end_impedance(const FemSettings& s, const SectionProperties& section) {
  if (s.end_dashpot_frequency == 0.0) return Eigen::Vector3d::Zero();
  const double omega = 2 * pi * s.end_dashpot_frequency;
  const auto bending = [&](double inertia) {
    return std::pow(s.material.young * inertia * omega * omega / (s.material.density * section.area), 0.25);
  };
  return s.material.density * Eigen::Vector3d(std::sqrt(s.material.young / s.material.density),
                                              bending(section.inertia_lateral), bending(section.inertia_vertical));
}

TrackSystem assemble_track(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner,
                           const RailKinematics& rail, RailMatrices matrices) {
  TrackSystem system;
  system.n_rail_dofs = rail.n_dofs();
  if (owner == SeatOwner::partner) system.coupled_seats = seats;
  system.support_seats = support_seats(settings, seats, owner);
  system.cells = CellOperator(rail, system.coupled_seats).matrix();
  system.support_cells = CellOperator(rail, system.support_seats).matrix();

  // Sleepers are measured from their own state of rest, as the coupled ones are: only the rail has weight here.
  const int n_sleeper = 3 * static_cast<int>(system.support_seats.size()), n = system.n_rail_dofs + n_sleeper;
  system.cells.conservativeResize(system.cells.rows(), n);
  add_nonlinear_pads(system, settings.support);
  system.weight = Eigen::VectorXd::Zero(n);
  if (settings.gravity) system.weight.head(system.n_rail_dofs) = matrices.weight;
  system.mass = std::move(matrices.mass);
  system.mass.conservativeResize(n, n);
  for (int dof = system.n_rail_dofs; dof < n; ++dof) system.mass.insert(dof, dof) = settings.support.sleeper_mass;
  system.mass.makeCompressed();

  Triplets stiffness, damping;
  add_pads(system, stiffness, damping);
  add_ballast(system, settings, stiffness, damping);
  for (int dof = 0; dof < system.n_rail_dofs; ++dof)
    if (matrices.end_damping[dof] != 0.0) damping.emplace_back(dof, dof, matrices.end_damping[dof]);
  system.support_stiffness = from(stiffness, n);
  system.support_damping = from(damping, n);
  system.rail_stiffness = std::move(matrices.stiffness);
  system.rail_stiffness.conservativeResize(n, n);
  system.stiffness_damping = settings.loss_factor / (2 * pi * settings.loss_factor_frequency);
  return system;
}

}  // namespace fem
