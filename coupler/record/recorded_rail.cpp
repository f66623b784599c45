#include "coupler/record/recorded_rail.hpp"

#include <algorithm>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"

namespace coupler {
namespace {

namespace field = proto::field;

[[noreturn]] void refuse(const std::string& problem, const std::string& path) {
  throw proto::Error(proto::ExitCode::bad_data, problem, path,
                     "coupling.one_way.history wants the coupling.h5 of a run with the same rail seats");
}

/// Appends the seats' columns `name` to every row.
void read_seats(const proto::ResultReader& file, const std::string& path, const std::vector<proto::RailSeat>& seats,
                const char* name, std::vector<std::vector<double>>& rows) {
  for (const auto& seat : seats) {
    const std::string column = "/seats/" + seat.name + "/" + name;
    const auto width = 3 * static_cast<std::size_t>(seat.n_cells());
    if (!file.has(column)) refuse("there is no " + column, path);
    const auto values = file.read_rows(column, rows.size()).values;
    if (values.size() != rows.size() * width) refuse(column + " has another number of cells", path);
    for (std::size_t row = 0; row < rows.size(); ++row)
      rows[row].insert(rows[row].end(), &values[row * width], &values[row * width] + width);
  }
}

}  // namespace

RecordedRail::RecordedRail(const std::string& path, const std::vector<proto::RailSeat>& seats, double duration_s) {
  const proto::ResultReader file(path);
  const auto n_rows = static_cast<std::size_t>(file.n_committed());
  if (n_rows < 2) refuse("it holds no window", path);
  time_ = file.read_rows("/time", n_rows).values;
  if (time_.back() < duration_s * (1 - 1e-9)) refuse("it ends at " + std::to_string(time_.back()) + " s", path);
  for (auto* rows : {&displacement_, &velocity_, &force_}) rows->resize(n_rows);
  read_seats(file, path, seats, field::rail_displacement, displacement_);
  read_seats(file, path, seats, field::rail_velocity, velocity_);
  read_seats(file, path, seats, field::force_used, force_);
}

std::vector<double> RecordedRail::at(const Rows& rows, double time) const {
  const auto after = std::upper_bound(time_.begin(), time_.end(), time);
  if (after == time_.end()) return rows.back();
  const auto i = static_cast<std::size_t>(after - time_.begin());
  const double s = (time - time_[i - 1]) / (time_[i] - time_[i - 1]);
  auto values = rows[i - 1];
  for (std::size_t k = 0; k < values.size(); ++k) values[k] += s * (rows[i][k] - rows[i - 1][k]);
  return values;
}

proto::Result RecordedRail::advance(const proto::Advance& request) {
  const bool march = request.phase == proto::Phase::march;
  const double time = march ? static_cast<double>(request.window + 1) * request.window_s : 0.0;
  proto::Result result{request.phase, request.window, request.iteration, 0.0, {}};
  result.data.set(field::rail_displacement, at(displacement_, time));
  result.data.set(field::rail_velocity, at(velocity_, time));
  // Forces are means over the windows that end at their rows.
  const auto force = at(force_, march ? time : time_[1]);
  result.data.set(field::force_used, force);
  result.data.set(field::force_robin, force);
  return result;
}

}  // namespace coupler
