#include "coupler/record/figures.hpp"

#include <algorithm>
#include <cmath>

namespace coupler {
namespace {

constexpr std::size_t normal_axis = 2;

/// Per seat, the sum over its cells of the normal component of `values`.
std::vector<double> normal_sums(const std::vector<double>& values, const std::vector<proto::RailSeat>& seats) {
  std::vector<double> sums;
  std::size_t first = 0;
  for (const auto& seat : seats) {
    double sum = 0.0;
    for (int cell = 0; cell < seat.n_cells(); ++cell)
      sum += values[first + 3 * static_cast<std::size_t>(cell) + normal_axis];
    sums.push_back(sum);
    first += 3 * static_cast<std::size_t>(seat.n_cells());
  }
  return sums;
}

}  // namespace

std::vector<double> seat_forces(const WindowRecord& record, const std::vector<proto::RailSeat>& seats,
                                double window_s) {
  auto forces = normal_sums(record.impulse, seats);
  for (auto& force : forces) force /= window_s;
  return forces;
}

void update_figures(std::vector<SeatFigures>& figures, const WindowRecord& record,
                    const std::vector<proto::RailSeat>& seats, double window_s) {
  const auto forces = seat_forces(record, seats, window_s);
  const auto rail = normal_sums(record.rail_displacement, seats);
  const auto sleeper = normal_sums(record.sleeper_displacement, seats);
  for (std::size_t s = 0; s < seats.size(); ++s) {
    auto& figure = figures[s];
    figure.max_force_n = std::max(figure.max_force_n, std::abs(forces[s]));
    figure.max_rail_displacement_m = std::max(figure.max_rail_displacement_m, std::abs(rail[s] / seats[s].n_cells()));
    figure.max_sleeper_displacement_m =
        std::max(figure.max_sleeper_displacement_m, std::abs(sleeper[s] / seats[s].n_cells()));
  }
}

void exchange(proto::StateArchive& archive, std::vector<SeatFigures>& figures) {
  for (auto& seat : figures) {
    const std::string name = "figures/" + seat.name + "/";
    archive(name + "max_force", seat.max_force_n);
    archive(name + "max_rail_displacement", seat.max_rail_displacement_m);
    archive(name + "max_sleeper_displacement", seat.max_sleeper_displacement_m);
  }
}

}  // namespace coupler
