// `coupler converge`: a case with H, H/2, H/4, ..., and the order at which its interface converges.
#include <fmt/format.h>

#include <cmath>

#include "coupler/app/case_input.hpp"
#include "coupler/app/options.hpp"
#include "coupler/record/run_folder.hpp"
#include "coupler/report/convergence.hpp"
#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

constexpr double allowed_shortfall = 0.2;  // of the observed below the expected order

double expected_order(proto::Scheme scheme) {
  return scheme == proto::Scheme::serial_staggered ? 1.0 : 2.0;
}

/// Reads one run's histories at the instants of the coarsest, whose windows hold `ratio` of this run's.
class Histories {
 public:
  Histories(const std::string& path, std::uint64_t ratio) : reader_(path), ratio_(ratio), n_(reader_.n_committed()) {}

  std::vector<double> at_instants(const std::string& column) const {
    const auto [values, width] = rows(column);
    std::vector<double> result;
    for (std::uint64_t row = 0; row < n_; row += ratio_) {
      result.insert(result.end(), &values[row * width], &values[row * width] + width);
    }
    return result;
  }

  /// Means of an impulse over the coarse windows.
  std::vector<double> mean_force(const std::string& column, double coarse_window_s) const {
    const auto [values, width] = rows(column);
    std::vector<double> result;
    for (std::uint64_t row = 1; row + ratio_ <= n_; row += ratio_) {
      for (std::size_t i = 0; i < width; ++i) {
        double sum = 0.0;
        for (std::uint64_t k = 0; k < ratio_; ++k) sum += values[(row + k) * width + i];
        result.push_back(sum / coarse_window_s);
      }
    }
    return result;
  }

 private:
  std::pair<std::vector<double>, std::size_t> rows(const std::string& column) const {
    auto values = reader_.read_rows(column, n_).values;
    const std::size_t width = values.size() / n_;
    return {std::move(values), width};
  }

  proto::ResultReader reader_;
  std::uint64_t ratio_, n_;
};

std::vector<Refinement> gather(const std::vector<std::string>& files, const CaseInput& input) {
  std::vector<Refinement> quantities;
  for (const auto& seat : input.seats) {
    const std::string group = "/seats/" + seat.name + "/";
    Refinement rail{seat.name + " rail displacement", "m", {}}, sleeper{seat.name + " sleeper displacement", "m", {}},
        force{seat.name + " mean pad force", "N", {}};
    for (std::size_t l = 0; l < files.size(); ++l) {
      const Histories run(files[l], std::uint64_t{1} << l);
      rail.levels.push_back(run.at_instants(group + "rail_displacement"));
      sleeper.levels.push_back(run.at_instants(group + "sleeper_displacement"));
      force.levels.push_back(run.mean_force(group + "impulse", input.coupling.window_s));
    }
    for (auto* quantity : {&rail, &sleeper, &force}) quantities.push_back(std::move(*quantity));
  }
  return quantities;
}

}  // namespace

int converge_case(const RunOptions& options, int n_levels) {
  auto input = read_case(options.case_path);
  const auto scheme = options.scheme.empty() ? input.coupling.scheme : proto::scheme_of(options.scheme);
  const RunFolder folder(options.out, input.file.name() + "-converge");
  std::vector<std::string> files;
  std::vector<double> windows;
  for (int level = 0; level < n_levels; ++level) {
    RunOptions run = options;
    run.window_s = input.coupling.window_s / std::exp2(level);
    run.out = folder.file("level_" + std::to_string(level));
    const int code = run_case(run);
    if (code != 0) return code;
    windows.push_back(run.window_s);
    files.push_back(run.out + "/coupling.h5");
  }
  std::vector<ObservedOrder> orders;
  for (const auto& quantity : gather(files, input)) orders.push_back(observed_order(quantity));
  fmt::print("{}", order_table(orders, windows));
  proto::write_text_file(folder.file("convergence.csv"), order_csv(orders, windows));
  fmt::print("distances between the levels in {}\n", folder.file("convergence.csv"));
  const double least = expected_order(scheme) - allowed_shortfall;
  for (const auto& order : orders) {
    if (order.last() >= least) continue;
    throw proto::Error(proto::ExitCode::numerics,
                       fmt::format("{} converges with order {:.2f}, scheme {} should with {:g}", order.name,
                                   order.last(), proto::name_of(scheme), expected_order(scheme)),
                       folder.path(), "begin with a shorter window: the order shows only where H resolves the motion");
  }
  return 0;
}

}  // namespace coupler
