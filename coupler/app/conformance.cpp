// `coupler conformance`: one participant alone through a scripted suite.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "coupler/app/case_input.hpp"
#include "coupler/app/kit.hpp"
#include "coupler/conformance/suite.hpp"
#include "coupler/launch/program_path.hpp"
#include "coupler/supervise/supervisor.hpp"
#include "proto/error.hpp"
#include "proto/result/text_file.hpp"

namespace coupler {
namespace {

namespace fs = std::filesystem;

struct ConformanceOptions {
  std::string case_path, name, json, out;
  std::vector<std::string> command, only;
  double amplitude_m = 1e-5;
};

conformance::Candidate candidate_of(const ConformanceOptions& options) {
  const auto input = read_case(options.case_path);
  conformance::Candidate candidate;
  candidate.name = options.name;
  candidate.coupling = input.coupling;
  candidate.seats = input.seats;
  candidate.case_path = fs::absolute(input.file.path()).string();
  candidate.case_hash = input.file.hash();
  candidate.amplitude_m = options.amplitude_m;
  const auto& of_case = options.name == "qdem" ? input.coupling.qdem : input.coupling.fem;
  candidate.command = options.command.empty() ? of_case.command : options.command;
  candidate.command.front() = find_program(candidate.command.front(), "the command of the participant");
  return candidate;
}

/// Where the participant writes: a folder that is asked for stays, one of our own goes when nothing failed.
class Workplace {
 public:
  explicit Workplace(const std::string& wanted) : own_(wanted.empty()), path_(wanted) {
    if (own_) path_ = (fs::temp_directory_path() / "conformance-XXXXXX").string();
    std::error_code error;
    const bool made = own_ ? mkdtemp(path_.data()) != nullptr : fs::create_directory(path_, error);
    if (!made)
      throw proto::Error(proto::ExitCode::cannot_create, "the output folder cannot be made", path_,
                         "--out must name a folder that is not there yet");
    path_ = fs::absolute(path_).string();
  }
  ~Workplace() {
    std::error_code ignored;
    if (own_ && !keep_) fs::remove_all(path_, ignored);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  const std::string& path() const { return path_; }
  void keep() { keep_ = true; }

 private:
  bool own_, keep_ = false;
  std::string path_;
};

int run_conformance(const ConformanceOptions& options) {
  const auto candidate = candidate_of(options);
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
