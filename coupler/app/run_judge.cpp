#include "coupler/app/run_judge.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "coupler/advisor/advice.hpp"
#include "proto/error.hpp"

namespace coupler {
namespace {

constexpr double allowed_tangent = 0.05;  // of the FEM's pad off the registered one

std::vector<AuditSeat> audit_seats(const std::vector<proto::RailSeat>& seats) {
  std::vector<AuditSeat> result;
  for (const auto& seat : seats) {
    result.push_back({{}, seat.half_lengths.norm()});
    for (int cell = 0; cell < seat.n_cells(); ++cell) {
      const Eigen::Vector3d arm = seat.axes.transpose() * (seat.cell_point(cell) - seat.origin);
      result.back().arms.push_back({arm[0], arm[1], arm[2]});
    }
  }
  return result;
}

double number_of(const std::vector<proto::Fact>& facts, const std::string& key) {
  for (const auto& fact : facts)
    if (fact.key == key) return fact.number.value_or(0.0);
  return 0.0;
}

}  // namespace

RunJudge::RunJudge(const CaseInput& input, spdlog::logger& log, Summary& summary)
    : input_(input),
      log_(log),
      summary_(summary),
      audit_(audit_seats(input.seats), input.coupling.window_s),
      watch_(input.coupling.audit),
      seen_(static_cast<std::int64_t>(input.coupling.n_windows), input.coupling.window_s) {}

void RunJudge::warn(const std::string& text) {
  log_.warn("{}", text);
  fmt::print(stderr, "coupler: warning: {}\n", text);
  summary_.warnings.push_back(text);
}

void RunJudge::advise(const std::vector<proto::PadLaw>& laws) {
  const auto& asked = input_.coupling.advisor;
  const double rail = asked.rail_mass > 0.0 ? asked.rail_mass : number_of(summary_.facts, "fem.seat_mass_kg");
  const double sleeper = asked.sleeper_mass > 0.0 ? asked.sleeper_mass : number_of(summary_.facts, "qdem.seat_mass_kg");
  if (!(rail > 0.0 && sleeper > 0.0)) {
    log_.info("no advice: neither the participants nor [coupling.advisor] give the masses that move with a seat");
    return;
  }
  const auto advice = coupler::advise(input_.coupling, lumped_seats(input_.seats, laws, rail, sleeper));
  if (!advice.text.empty()) log_.info("{}", advice.text);
  for (const auto& text : advice.warnings) warn(text);
  if (advice.refusal.empty()) return;
  if (!asked.accept_unstable)
    throw proto::Error(
        proto::ExitCode::config, advice.refusal, "set-up",
        "shorten coupling.window_s, take R1 or implicit, or set coupling.advisor.accept_unstable = true");
  warn(advice.refusal);
}

WindowAudit RunJudge::add(const WindowRecord& record) {
  auto defects = audit_.add(record);
  seen_.add(record);
  return defects;
}

void RunJudge::report() {
  summary_.energy_defect_relative = audit_.energy_defect_relative();
  summary_.momentum_defect_relative = audit_.momentum_defect_relative();
  summary_.moment_defect_relative = audit_.moment_defect_relative();
  summary_.observation = seen_;
}

void RunJudge::exchange(proto::StateArchive& archive) {
  audit_.exchange(archive);
  watch_.exchange(archive);
  seen_.exchange(archive);
}

std::optional<proto::Scheme> RunJudge::judge(const std::string& stage, bool last) {
  using Action = proto::AuditLimits::Action;
  const auto& limits = input_.coupling.audit;
  if (limits.action == Action::report) return std::nullopt;
  const auto beyond = watch_.look(audit_, last);
  if (beyond.empty()) return std::nullopt;
  const auto text = fmt::format("{}", fmt::join(beyond, "; "));
  if (limits.action == Action::stop)
    throw proto::Error(proto::ExitCode::numerics, text, stage,
                       "shorten coupling.window_s, take a better scheme, or set coupling.audit.action = \"warn\"");
  if (limits.action == Action::warn || last) {
    warn(text);
    return std::nullopt;
  }
  if (!summary_.switched_to.empty()) return std::nullopt;
  summary_.switched_to = proto::name_of(limits.switch_to);
  warn(fmt::format("{}: {} from here on", text, summary_.switched_to));
  return limits.switch_to;
}

void RunJudge::observe() {
  log_.info("observed: {}", seen_.text());
  if (input_.coupling.scheme != proto::Scheme::one_way && seen_.law_deviation() > allowed_tangent)
    warn(
        fmt::format("the pad of fem is {:.1f} % off the one that qdem registered: what crosses the interface does not "
                    "converge with shorter windows",
                    100.0 * seen_.law_deviation()));
}

}  // namespace coupler
