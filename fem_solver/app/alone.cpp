#include "fem_solver/app/alone.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace fem {
namespace {

WheelTrack make_track(const FemCase& input, const FemProgram& program, const RailModel& rail) {
  return WheelTrack(rail, input.fem, input.wheel, program.build_wheel(input.wheel), input.coupling.window_s, {});
}

void print_section(const RailModel& rail, const FemSettings& settings) {
  const RailFigures figures = rail.figures();
  const SectionProperties& p = figures.section;
  const double mass = p.area * settings.material.density;
  std::printf("section %s: area %.3f cm2, I vertical %.1f cm4, I lateral %.1f cm4, centroid %.1f mm, %.2f kg/m\n",
              settings.profile.c_str(), p.area * 1e4, p.inertia_vertical * 1e8, p.inertia_lateral * 1e8,
              p.centroid_height * 1e3, mass);
  if (const auto table = settings.profile_is_file ? std::nullopt : standard_figures(settings.profile))
    std::printf(
        "  %s: area %.2f cm2 (%+.2f %%), I vertical %.1f cm4 (%+.2f %%), I lateral %.1f cm4 (%+.2f %%), "
        "%.2f kg/m (%+.2f %%)\n",
        table->source.c_str(), table->area * 1e4, 100 * (p.area / table->area - 1), table->inertia_vertical * 1e8,
        100 * (p.inertia_vertical / table->inertia_vertical - 1), table->inertia_lateral * 1e8,
        100 * (p.inertia_lateral / table->inertia_lateral - 1), table->mass, 100 * (mass / table->mass - 1));
  std::printf("rail %.2f m, %d elements of %.3f m length, %d unknowns\n", figures.length, figures.n_elements,
              figures.element_length, rail.track().n_dofs());
}

// Vertical pad force that presses on each support [N].
std::vector<double> seat_forces(const TrackSystem& system, const TrackState& state) {
  const Eigen::VectorXd u = system.support_cells * state.displacement.head(system.n_rail_dofs);
  const Eigen::VectorXd v = system.support_cells * state.velocity.head(system.n_rail_dofs);
  std::vector<double> forces;
  Eigen::Index value = 2;
  for (std::size_t i = 0; i < system.support_seats.size(); ++i) {
    const auto& seat = system.support_seats[i];
    const int sleeper = system.sleeper_dof(static_cast<int>(i), 0);
    const double x = seat.axes.col(2).dot(state.displacement.segment<3>(sleeper));
    const double y = seat.axes.col(2).dot(state.velocity.segment<3>(sleeper));
    const proto::PadLaw law = seat.cell_law(2);
    double sum = 0.0;
    for (int cell = 0; cell < seat.n_cells(); ++cell, value += 3) {
      const double gap = u[value] - x, rate = v[value] - y;
      sum -= law.stiffness * gap + law.damping * rate;
      if (!system.support_laws.empty())
        sum -= system.support_laws[static_cast<std::size_t>(value / 3)].force(gap, rate);
    }
    forces.push_back(sum);
  }
  return forces;
}

}  // namespace

void check_case(const FemCase& input, const FemProgram& program) {
  const auto rail = program.build(input.fem, input.seats, SeatOwner::partner);
  const RunningBand& band = rail->band();
  band.at(input.wheel.start);
  band.at(input.wheel.start +
          input.wheel.speed * input.coupling.window_s * static_cast<double>(input.coupling.n_windows));
  program.build_wheel(input.wheel);
  make_wheel_contact(input.wheel, input.coupling.window_s);
}

void print_static(const FemCase& input, const FemProgram& program) {
  const auto rail = program.build(input.fem, input.seats, SeatOwner::own_supports);
  const TrackSystem& system = rail->track();
  print_section(*rail, input.fem);
  const WheelTrack track = make_track(input, program, *rail);
  const auto& state = track.state();
  const WheelModel& wheel = track.wheel_model();
  const double hertz = track.hertz().at_force(input.wheel.static_load).approach;
  std::printf("wheel of %.1f kN at x = %.3f m: rail %.4f mm, Hertz approach %.4f mm, wheel %.4f mm\n",
              input.wheel.static_load * 1e-3, input.wheel.start, (resting_contact(wheel, state.wheel) + hertz) * 1e3,
              hertz * 1e3, state.wheel.hub() * 1e3);
  std::printf("wheel of %d degrees of freedom: flattened by %.4f mm between hub and contact\n", wheel.n_dofs(),
              (resting_contact(wheel, state.wheel) - state.wheel.hub()) * 1e3);
  const auto forces = seat_forces(system, state.track);
  for (std::size_t i = 0; i < forces.size(); ++i)
    std::printf("seat at x = %6.2f m: %9.3f kN\n", system.support_seats[i].origin[0], forces[i] * 1e-3);
}

void run_alone(const FemCase& input, const FemProgram& program, const std::string& out) {
  check_case(input, program);
  const auto rail = program.build(input.fem, input.seats, SeatOwner::own_supports);
  const TrackSystem& system = rail->track();
  print_section(*rail, input.fem);
  WheelTrack track = make_track(input, program, *rail);
  FemRecord record(out, program.name, input.file, *rail, track, input.coupling.window_s,
                   windows_per_output(input.coupling.output_interval_s, input.coupling.window_s));
  record.begin(track);
  double largest = 0.0, smallest = input.wheel.static_load;
  std::vector<double> largest_seat(system.support_seats.size(), 0.0);
  const auto begin = std::chrono::steady_clock::now();
  for (std::uint64_t n = 0; n < input.coupling.n_windows; ++n) {
    track.march({});
    record.window(track);
    largest = std::max(largest, track.contact_force()), smallest = std::min(smallest, track.contact_force());
    const auto forces = seat_forces(system, track.state().track);
    for (std::size_t i = 0; i < forces.size(); ++i) largest_seat[i] = std::max(largest_seat[i], forces[i]);
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  record.close();
  std::printf("%llu windows in %.1f s (%.2f ms each); contact force %.2f to %.2f kN\n",
              static_cast<unsigned long long>(input.coupling.n_windows), wall.count(),
              1e3 * wall.count() / static_cast<double>(input.coupling.n_windows), smallest * 1e-3, largest * 1e-3);
  for (std::size_t i = 0; i < largest_seat.size(); ++i)
    std::printf("seat at x = %6.2f m: largest force %8.3f kN\n", system.support_seats[i].origin[0],
                largest_seat[i] * 1e-3);
  std::printf("results: %s/fem.h5\n", out.c_str());
}

}  // namespace fem
