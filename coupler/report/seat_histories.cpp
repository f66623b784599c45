#include "coupler/report/seat_histories.hpp"

#include "proto/result/reader.hpp"

namespace coupler {
namespace {

/// One run's histories at the instants of the coarsest, whose windows hold `ratio` of this run's.
class Histories {
 public:
  Histories(const std::string& path, std::uint64_t n_coarse_rows, SeatValues which)
      : reader_(path), n_(reader_.n_committed()), ratio_((n_ - 1) / (n_coarse_rows - 1)), which_(which) {}

  std::vector<double> at_instants(const std::string& column) const {
    const auto [values, width] = rows(column, true);
    std::vector<double> result;
    for (std::uint64_t row = 0; row < n_; row += ratio_)
      result.insert(result.end(), values.begin() + static_cast<std::ptrdiff_t>(row * width),
                    values.begin() + static_cast<std::ptrdiff_t>((row + 1) * width));
    return result;
  }

  /// Means of an impulse over the coarse windows.
  std::vector<double> mean_force(const std::string& column) const {
    const auto [values, width] = rows(column, false);
    const double window_s = reader_.number("/", "window_s") * static_cast<double>(ratio_);
    std::vector<double> result;
    for (std::uint64_t row = 1; row + ratio_ <= n_; row += ratio_) {
      for (std::size_t i = 0; i < width; ++i) {
        double sum = 0.0;
        for (std::uint64_t k = 0; k < ratio_; ++k) sum += values[(row + k) * width + i];
        result.push_back(sum / window_s);
      }
    }
    return result;
  }

 private:
  /// Values of all rows and their number in a row; over the cells of the seat the mean or the sum, if that is wanted.
  std::pair<std::vector<double>, std::size_t> rows(const std::string& column, bool mean) const {
    auto values = reader_.read_rows(column, n_).values;
    const std::size_t width = values.size() / n_, n_cells = width / 3;
    if (which_ == SeatValues::cells) return {std::move(values), width};
    std::vector<double> seat(3 * n_, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i)
      seat[3 * (i / width) + i % 3] += values[i] / (mean ? static_cast<double>(n_cells) : 1.0);
    return {std::move(seat), 3};
  }

  proto::ResultReader reader_;
  std::uint64_t n_, ratio_;
  SeatValues which_;
};

}  // namespace

std::vector<Refinement> seat_refinements(const std::vector<std::string>& files,
                                         const std::vector<proto::RailSeat>& seats, SeatValues which) {
  const std::uint64_t n_coarse_rows = proto::ResultReader(files.front()).n_committed();
  std::vector<Refinement> quantities;
  for (const auto& seat : seats) {
    const std::string group = "/seats/" + seat.name + "/";
    Refinement rail{seat.name + " rail displacement", "m", {}}, sleeper{seat.name + " sleeper displacement", "m", {}},
        force{seat.name + " mean pad force", "N", {}};
    for (const auto& file : files) {
      const Histories run(file, n_coarse_rows, which);
      rail.levels.push_back(run.at_instants(group + "rail_displacement"));
      sleeper.levels.push_back(run.at_instants(group + "sleeper_displacement"));
      force.levels.push_back(run.mean_force(group + "impulse"));
    }
    for (auto* quantity : {&rail, &sleeper, &force}) quantities.push_back(std::move(*quantity));
  }
  return quantities;
}

}  // namespace coupler
