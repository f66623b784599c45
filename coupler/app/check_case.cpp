#include <fmt/format.h>
#include "coupler/app/case_input.hpp"
#include "coupler/app/options.hpp"
#include "coupler/launch/children.hpp"
#include "coupler/launch/program_path.hpp"

#include "proto/error.hpp"

namespace coupler {
namespace {

constexpr int check_limit_s = 120;

/// Runs `<program> check --case` with the coupler's own stderr; its exit.
ChildExit run_check(Children& children, const proto::ParticipantSpec& spec, const std::string& case_path) {
  children.start({spec.name, {spec.command.front(), "check", "--case", case_path}, {}, {}});
  for (int waited = 0; waited < check_limit_s * 10 && !children.exit_of(spec.name); ++waited) {
    children.wait(0.1);
    if (const int signal = children.stop_signal()) return {spec.name, 128 + signal, 0};
  }
  const auto exit = children.exit_of(spec.name);
  if (!exit)
    throw proto::Error(proto::ExitCode::unavailable,
                       spec.command.front() + " check did not end within " + std::to_string(check_limit_s) + " s");
  return *exit;
}

}  // namespace

int check_case(const RunOptions& options) {
  auto input = read_case(options.case_path);
  use_programs(input.coupling, options.fem, options.qdem);
  Children children(own_path());
  for (const auto& spec : find_participants(input)) {
    const auto exit = run_check(children, spec, input.file.path());
    if (exit.signal) throw proto::Error(proto::ExitCode::unavailable, spec.command.front() + " check " + exit.text());
    if (exit.code) return exit.code;
  }
  fmt::print("{}: valid\n", options.case_path);
  return 0;
}

}  // namespace coupler
