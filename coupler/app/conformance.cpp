// `coupler conformance`: one participant alone through a scripted suite.
#include <fmt/format.h>

#include <memory>

#include "coupler/app/kit.hpp"
#include "coupler/app/kit_candidate.hpp"
#include "coupler/conformance/suite.hpp"
#include "coupler/supervise/supervisor.hpp"
#include "proto/error.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

struct ConformanceOptions {
  std::string case_path, name, json, out;
  std::vector<std::string> command, only;
  double amplitude_m = 1e-5;
};

int run_conformance(const ConformanceOptions& options) {
  auto candidate = find_candidate(options.case_path, options.name, options.command);
  candidate.amplitude_m = options.amplitude_m;
  Workplace workplace(options.out);
  conformance::Bench bench(candidate, workplace.path());
  fmt::print("{} as {} in {}\n", fmt::join(candidate.command, " "), candidate.name, options.case_path);
  const std::set<std::string> only(options.only.begin(), options.only.end());
  try {
    const auto findings = conformance::run_suite(bench, only, [](const auto& finding) {
      fmt::print("{}", conformance::report_line(finding));
      std::fflush(stdout);
    });
    if (!options.json.empty()) proto::write_text_file(options.json, conformance::report_json(candidate, findings));
    const bool conforms = conformance::conforms(findings);
    fmt::print("{}\n", conforms ? "conforms" : "does not conform; its logs are in " + workplace.path());
    if (conforms) return 0;
    workplace.keep();
    return static_cast<int>(proto::ExitCode::protocol);
  } catch (const Interrupted& interrupted) {
    return 128 + interrupted.signal();
  }
}

std::vector<std::string> check_names() {
  std::vector<std::string> names;
  for (const auto& check : conformance::all_checks()) names.emplace_back(check.name);
  return names;
}

}  // namespace

void add_conformance_command(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("conformance", "drive one participant alone through the protocol's test suite");
  const auto options = std::make_shared<ConformanceOptions>();
  command->add_option("--case", options->case_path, "case file (TOML)")->required();
  command->add_option("--name", options->name, "role to play")->required()->check(CLI::IsMember({"qdem", "fem"}));
  command->add_option("COMMAND", options->command,
                      "after --: program and first arguments of the participant (default: the case's)");
  command->add_option("--json", options->json, "write the report to this file");
  command->add_option("--out", options->out, "new folder for the participant's output (default: a temporary one)");
  command->add_option("--only", options->only, "names of checks")->delimiter(',')->check(CLI::IsMember(check_names()));
  command->add_option("--amplitude", options->amplitude_m, "of the other side's motion [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->callback([options, &chosen] { chosen = [options] { return run_conformance(*options); }; });
}

}  // namespace coupler
