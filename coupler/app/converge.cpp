// `coupler converge`: a case that is refined again and again, and the order at which its interface converges.
#include <fmt/format.h>

#include "coupler/app/case_input.hpp"
#include "coupler/app/drawing.hpp"
#include "coupler/app/options.hpp"
#include "coupler/app/refined_case.hpp"
#include "coupler/record/run_folder.hpp"
#include "coupler/report/convergence.hpp"
#include "coupler/report/seat_histories.hpp"
#include "proto/error.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

constexpr double allowed_shortfall = 0.2;  // of the observed below the expected order

/// What is refined, and how far at one level.
class Ladder {
 public:
  Ladder(const RunOptions& options, const CaseInput& input, const RunFolder& folder)
      : options_(options), input_(input), folder_(folder) {}

  /// The run of level `level`.
  RunOptions run(int level) const {
    RunOptions run = options_;
    run.out = folder_.file("level_" + std::to_string(level));
    const int factor = 1 << level;
    if (options_.over == Refine::window) run.window_s = input_.coupling.window_s / factor;
    if (options_.over == Refine::sub_cycles) run.sub_cycle_factor = input_.coupling.sub_cycle_factor * factor;
    if (options_.over == Refine::cells) {
      run.case_path = folder_.file("level_" + std::to_string(level) + ".toml");
      proto::write_text_file(run.case_path, with_finer_cells(input_.file, factor));
    }
    return run;
  }

  RefinedBy refined_by(int n_levels) const {
    const double first = options_.over == Refine::window ? input_.coupling.window_s : 1.0;
    RefinedBy by{options_.over == Refine::window       ? "window [s]"
                 : options_.over == Refine::sub_cycles ? "step of the sub-cycles [of the coarsest]"
                                                       : "cell size [of the coarsest]",
                 {}};
    for (int level = 0; level < n_levels; ++level) by.values.push_back(first / (1 << level));
    return by;
  }

  double expected_order(proto::Scheme scheme) const {
    return options_.over == Refine::window ? proto::expected_order(scheme) : 2.0;
  }

 private:
  const RunOptions& options_;
  const CaseInput& input_;
  const RunFolder& folder_;
};

}  // namespace

int converge_case(const RunOptions& options, int n_levels) {
  auto input = read_case(options.case_path);
  const auto scheme = options.scheme.empty() ? input.coupling.scheme : proto::scheme_of(options.scheme);
  const RunFolder folder(options.out, input.file.name() + "-converge");
  const Ladder ladder(options, input, folder);
  std::vector<std::string> files;
  for (int level = 0; level < n_levels; ++level) {
    const auto run = ladder.run(level);
    const int code = run_case(run);
    if (code != 0) return code;
    files.push_back(run.out + "/coupling.h5");
  }
  const auto by = ladder.refined_by(n_levels);
  const double expected = ladder.expected_order(scheme);
  const bool means = options.over == Refine::cells;
  std::vector<ObservedOrder> orders;
  for (const auto& quantity : seat_refinements(files, input.seats, means ? SeatValues::means : SeatValues::cells))
    orders.push_back(observed_order(quantity));
  fmt::print("{}", order_table(orders, by));
  const auto csv = folder.file("convergence.csv"), script = folder.file("convergence.gnuplot"),
             svg = folder.file("convergence.svg");
  proto::write_text_file(csv, order_csv(orders, by));
  proto::write_text_file(script, order_plot(orders, by, expected, csv, svg));
  fmt::print("distances between the levels in {}\n", csv);
  draw("gnuplot", {script}, script, svg);
  for (const auto& order : orders) {
    if (!order.has_order() || order.last() >= expected - allowed_shortfall) continue;
    throw proto::Error(proto::ExitCode::numerics,
                       fmt::format("{} converges with order {:.2f}, scheme {} should with {:g}", order.name,
                                   order.last(), proto::name_of(scheme), expected),
                       folder.path(), "begin finer: the order shows only where the motion is resolved");
  }
  return 0;
}

}  // namespace coupler
