// qdem_solver: ballast and sleeper, as a participant or alone.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "proto/case/case_file.hpp"
#include "proto/error.hpp"
#include "proto/session/participant.hpp"
#include "qdem_solver/app/commands.hpp"
#include "qdem_solver/app/forecast.hpp"
#include "qdem_solver/participant/qdem_participant.hpp"

namespace {

struct Arguments {
  std::string case_path, endpoint, out = ".", name = "qdem", bed_path = "bed.h5", stones = "stones", json_path;
  qdem::bed::Roughness roughness;
  bool on_cuda = false;
  proto::KeyFiles keys;
};

void check(const Arguments& arguments) {
  const auto file = proto::CaseFile::load(arguments.case_path);
  qdem::check_command(file);
  qdem::print_figures(file);
  qdem::print_forecast(file);
}

void participate(const Arguments& arguments) {
  auto file = proto::CaseFile::load(arguments.case_path);
  const auto options = proto::read_session_options(arguments.endpoint, file.hash(), arguments.keys);
  qdem::check_command(file);
  qdem::QdemParticipant participant(std::move(file), qdem::bed_of_case, arguments.name, arguments.out);
  proto::serve(participant, options);
}

/// Parses the command line and runs the command. CLI11's own errors are turned into usage errors.
int run(int argc, char** argv) {
  CLI::App app{"Ballast stones and sleeper as bodies of four-particle viscoelastic elements"};
  app.require_subcommand(1);
  Arguments arguments;

  auto* run = app.add_subcommand("run", "integrate the bed by itself, as [qdem.run] says");
  run->add_option("case", arguments.case_path, "case file")->required();
  run->add_option("--out", arguments.out, "folder for qdem.h5");
  run->callback([&] { qdem::run_command(arguments.case_path, arguments.out); });

  auto* bed = app.add_subcommand("bed", "build the bed and write it to a file");
  bed->add_option("case", arguments.case_path, "case file")->required();
  bed->add_option("-o,--output", arguments.bed_path, "file to write");
  bed->callback([&] { qdem::bed_command(arguments.case_path, arguments.bed_path); });

  auto* bench = app.add_subcommand("bench", "measure the solver's rates beside those of the machine");
  auto* bed_case = bench->add_option("--case", arguments.case_path, "case whose bed is stepped");
  auto* json = bench->add_option("--json", arguments.json_path, "file for the figures");
  bench->add_flag("--cuda", arguments.on_cuda, "only the rates of the CUDA engine")->excludes(bed_case)->excludes(json);
  bench->callback([&] {
    if (arguments.on_cuda) return qdem::device_bench_command();
    qdem::bench_command(arguments.case_path, arguments.json_path);
  });

  auto* stones = app.add_subcommand("stones", "write the case's stone templates as STL, in mm at the sieve size d50");
  stones->add_option("case", arguments.case_path, "case file")->required();
  stones->add_option("-o,--output", arguments.stones, "folder to write to");
  stones->add_option("--roughness", arguments.roughness.height, "uneven faces as of a scan: height over sieve size")
      ->check(CLI::Range(0.0, 0.1));
  stones->add_option("--facets", arguments.roughness.least_facets, "cut facets until a stone has so many")
      ->check(CLI::Range(0, 100000));
  stones->callback([&] { qdem::stones_command(arguments.case_path, arguments.stones, arguments.roughness); });

  auto* checker =
      app.add_subcommand("check", "validate the case without running it; what it will take of memory and time");
  checker->add_option("--case", arguments.case_path, "case file")->required();
  checker->callback([&] { check(arguments); });

  auto* schema = app.add_subcommand("schema", "print the JSON Schema of the sections that it reads");
  schema->callback([] { qdem::schema_command(); });

  auto* participant = app.add_subcommand("participant", "take part in a coupled run; started by the coupler");
  participant->add_option("--case", arguments.case_path, "case file")->required();
  participant->add_option("--endpoint", arguments.endpoint, "where the coupler listens")->required();
  participant->add_option("--server-key", arguments.keys.server, "public key of a coupler on another machine");
  participant->add_option("--key", arguments.keys.own, "own secret key");
  participant->add_option("--out", arguments.out, "folder for results");
  participant->add_option("--name", arguments.name, "name in the session");
  participant->callback([&] { participate(arguments); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(proto::ExitCode::usage);
  }
  return 0;
}

/// Threads that wait shall spin for about ten microseconds, then sleep: unlimited spinning stands in the way of the
/// other processes of a coupled run, and on a busy machine of each other (measured: up to 60 times slower); sleeping at
/// once costs a wake-up per loop (measured: 15.3 s instead of 10.5 s for a bed of 127 stones). libgomp reads its
/// environment before main() begins, hence the second start of the program. A user's own setting is left alone.
void limit_spinning(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  setenv("GOMP_SPINCOUNT", "20000", 1);
  execv("/proc/self/exe", argv);  // returns only when it fails; then the threads spin, and all else is the same
}

}  // namespace

int main(int argc, char** argv) {
  limit_spinning(argv);
  spdlog::set_pattern("%v");  // whoever keeps the log knows the time
  try {
    return run(argc, argv);
  } catch (const proto::Error& error) {
    fmt::print(stderr, "qdem_solver: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "qdem_solver: {} - an unexpected error\n", error.what());
    return static_cast<int>(proto::ExitCode::internal);
  }
}
