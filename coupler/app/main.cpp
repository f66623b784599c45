// coupler: starts the participants of a case, keeps them in step, audits the interface, writes the record.
#include <fmt/format.h>
#include <signal.h>
#include <spdlog/version.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <map>

#include "coupler/app/analyze_options.hpp"
#include "coupler/app/kit.hpp"
#include "coupler/launch/children.hpp"
#include "coupler/launch/exec_child.hpp"
#include "proto/case/coupling.hpp"
#include "proto/error.hpp"
#include "proto/result/provenance.hpp"
#include "proto/wire/codec.hpp"

namespace {

std::string version_text() {
  return fmt::format("coupler {} ({})\nprotocol {}.{}, schema {:016x}\nlibuv {}, spdlog {}.{}.{}, fmt {}, CLI11 {}",
                     proto::project_version(), proto::source_description(), proto::protocol_major,
                     proto::protocol_minor, proto::schema_hash(), coupler::process_library_version(), SPDLOG_VER_MAJOR,
                     SPDLOG_VER_MINOR, SPDLOG_VER_PATCH, FMT_VERSION, CLI11_VERSION);
}

int command_line(int argc, char** argv) {
  CLI::App app("Coupled simulation of ballasted track: runs a case with its participants.", "coupler");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  coupler::RunOptions options;
  int n_levels = 4;
  const auto add_command = [&](const char* name, const char* what) {
    auto* command = app.add_subcommand(name, what);
    command->add_option("CASE", options.case_path, "case file (TOML)")->required();
    command->add_option("--fem", options.fem, "rail and wheel instead of the case's: solid, beam, or a program");
    command->add_option("--qdem", options.qdem, "stones and sleeper instead of the case's: a program");
    return command;
  };
  const auto add_runner = [&](const char* name, const char* what) {
    auto* command = add_command(name, what);
    command->add_option("--out", options.out, "output folder, new or empty (default: runs/<case>-<time>)");
    command->add_option("--scheme", options.scheme, "coupling scheme instead of the case's")
        ->check(CLI::IsMember(proto::scheme_names()));
    command->add_option("--threads", options.n_threads, "threads of each participant (sets OMP_NUM_THREADS)")
        ->check(CLI::Range(1, 4096));
    return command;
  };
  auto* run = add_runner("run", "run a case, or go on with an interrupted run");
  auto* resume =
      run->add_option("--resume", options.resume, "folder of an earlier run: go on from its newest checkpoint");
  run->get_option("CASE")->required(false);
  run->get_option("--out")->excludes(resume);
  run->add_option("--allow", options.allowed, "what may differ from the run that is resumed: case, version, program")
      ->delimiter(',')
      ->check(CLI::IsMember({"case", "version", "program"}))
      ->needs(resume);
  run->add_option("--wall-limit", options.wall_limit_s,
                  "seconds of wall time after which to save a checkpoint and stop")
      ->check(CLI::PositiveNumber);
  run->add_flag("--record", options.record, "write every frame to frames.log, for coupler replay");
  run->add_option("--restart", options.n_restarts, "how often to go on by itself when a participant is lost")
      ->check(CLI::Range(0, 1000));
  auto* converge = add_runner("converge", "run a case finer and finer and report the observed orders");
  const std::map<std::string, coupler::Refine> refined{{"window", coupler::Refine::window},
                                                       {"sub_cycles", coupler::Refine::sub_cycles},
                                                       {"cells", coupler::Refine::cells}};
  converge->add_option("--over", options.over, "what is refined: window, sub_cycles or cells (default: window)")
      ->transform(CLI::CheckedTransformer(refined));
  converge->add_option("--levels", n_levels, "number of runs")->check(CLI::Range(3, 12))->capture_default_str();
  coupler::AnalyzeOptions analysis;
  const auto* analyze = coupler::add_analyze_command(app, analysis);
  coupler::ReportOptions page;
  auto* report = app.add_subcommand("report", "write one HTML page of a run, or of several to compare");
  report->add_option("DIR", page.folders, "output folders of runs")->required();
  report->add_option("--out", page.out,
                     "file (default: report.html, of several runs comparison.html, in the first DIR)");
  report->add_option("--size-limit", page.size_limit_mb, "largest size of the page [MB]")
      ->check(CLI::Range(1.0, 500.0))
      ->capture_default_str();
  coupler::Action chosen;
  coupler::add_kit_commands(app, chosen);
  auto* check = add_command("check", "validate a case without running it");
  try {
    app.parse(argc, argv);
    if (run->parsed() && options.case_path.empty() && options.resume.empty())
      throw CLI::RequiredError("CASE or --resume");
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(proto::ExitCode::usage);
  }
  if (chosen) return chosen();
  if (analyze->parsed()) return coupler::analyze_run(analysis);
  if (report->parsed()) return coupler::report_runs(page);
  if (converge->parsed()) return coupler::converge_case(options, n_levels);
  if (check->parsed()) return coupler::check_case(options);
  return options.resume.empty() ? coupler::run_case(options) : coupler::resume_run(options);
}

}  // namespace

int main(int argc, char** argv) {
  signal(SIGPIPE, SIG_IGN);
  try {
    if (argc > 1 && argv[1] == std::string(coupler::exec_child_subcommand))
      coupler::exec_child(std::vector<std::string>(argv + 1, argv + argc));
    return command_line(argc, argv);
  } catch (const proto::Error& error) {
    fmt::print(stderr, "coupler: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "coupler: internal error: {}\n", error.what());
    return static_cast<int>(proto::ExitCode::internal);
  }
}
