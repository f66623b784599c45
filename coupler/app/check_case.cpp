#include <fmt/format.h>

#include <filesystem>

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

/// The programs that check the case: its participants, or qdem_solver where the case is one for that alone, with
/// [qdem.run] and without [coupling].
std::vector<proto::ParticipantSpec> checkers(const RunOptions& options) {
  const auto file = proto::CaseFile::load(options.case_path);
  if (!file.section("coupling").has("window_s") && file.section("qdem").section("run").has("duration_s")) {
    refuse_unknown_sections(file);
    return {{"qdem", {find_program("qdem_solver", "check")}}};
  }
  auto input = read_case(options.case_path);
  use_programs(input.coupling, options.fem, options.qdem);
  return find_participants(input);
}

}  // namespace

int check_case(const RunOptions& options) {
  const auto path = std::filesystem::absolute(options.case_path).string();
  Children children(own_path());
  for (const auto& spec : checkers(options)) {
    const auto exit = run_check(children, spec, path);
    if (exit.signal) throw proto::Error(proto::ExitCode::unavailable, spec.command.front() + " check " + exit.text());
    if (exit.code) return exit.code;
  }
  fmt::print("{}: valid\n", options.case_path);
  return 0;
}

}  // namespace coupler
