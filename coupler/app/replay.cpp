// `coupler replay`: one side of a recorded run from its record, the other one live.
#include <fmt/format.h>

#include <memory>

#include "coupler/app/kit.hpp"
#include "coupler/app/kit_candidate.hpp"
#include "coupler/conformance/replay.hpp"
#include "proto/error.hpp"

namespace coupler {
namespace {

struct ReplayOptions {
  std::string folder, played, case_path, out;
  std::vector<std::string> command;
  double tolerance = 0.0;
};

int run_replay(const ReplayOptions& options) {
  const std::string name = options.played == "qdem" ? "fem" : "qdem";
  FrameLogReader log(options.folder + "/frames.log");
  const auto case_path = options.case_path.empty() ? options.folder + "/case.toml" : options.case_path;
  const auto candidate = find_candidate(case_path, name, options.command);
  Workplace workplace(options.out);
  conformance::Bench bench(candidate, workplace.path());
  conformance::Settings settings;
  settings.folder = bench.new_folder();
  conformance::Subject subject(bench, settings);
  fmt::print("{} as {}; {} from {}\n", fmt::join(candidate.command, " "), name, options.played, options.folder);
  const auto report = conformance::replay(subject, log, name, settings.folder);
  if (report.n_results == 0)
    throw proto::Error(proto::ExitCode::bad_data, "the record holds no answer of " + name, options.folder);
  fmt::print("{}", conformance::replay_table(report));
  const bool same =
      options.tolerance > 0.0 ? report.largest_relative() <= options.tolerance : report.first_difference.empty();
  return same ? 0 : static_cast<int>(proto::ExitCode::numerics);
}

}  // namespace

void add_replay_command(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("replay", "run one participant against the record of a run");
  const auto options = std::make_shared<ReplayOptions>();
  command->add_option("DIR", options->folder, "folder of a run that was made with --record")->required();
  command->add_option("--as", options->played, "the side that comes from the record")
      ->required()
      ->check(CLI::IsMember({"qdem", "fem"}));
  command->add_option("COMMAND", options->command,
                      "after --: program and first arguments of the other side (default: the case's)");
  command->add_option("--case", options->case_path, "case file with the run's text (default: DIR/case.toml)");
  command->add_option("--out", options->out, "new folder for the participant's output (default: a temporary one)");
  command->add_option("--tolerance", options->tolerance, "largest relative difference (default 0: the same bytes)")
      ->check(CLI::NonNegativeNumber);
  command->callback([options, &chosen] { chosen = [options] { return run_replay(*options); }; });
}

}  // namespace coupler
