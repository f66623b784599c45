#include "proto/case/coupling.hpp"

#include <cmath>

#include "proto/error.hpp"

namespace proto {
namespace {

constexpr double most_windows = 1e9;

std::uint64_t read_window_count(const Section& section, double window_s) {
  const double duration = section.number("duration_s", Range::positive());
  const double count = duration / window_s, whole = std::round(count);
  if (count > most_windows) section.fail("duration_s", "more than 1e9 windows are asked for", "check window_s");
  if (whole < 1.0 || std::abs(count - whole) > 1e-9 * whole)
    section.fail("duration_s", "the duration is not a whole number of windows", "give a multiple of window_s");
  return static_cast<std::uint64_t>(whole);
}

ParticipantSpec read_participant(const Section& section, const std::string& name) {
  const std::string key = name + "_command";
  ParticipantSpec spec{name, section.texts_or(key, {name + "_solver", "participant"})};
  if (spec.command.empty() || spec.command.front().empty())
    section.fail(key, "the command is empty", "give the program and its first arguments");
  return spec;
}

Initialise read_initialise(const Section& section, double window_s) {
  Initialise result;
  result.window_s = section.number_or("window_s", window_s, Range::positive());
  const auto count = [&](const char* key, int fallback, double lowest) {
    return static_cast<int>(section.integer_or(key, fallback, Range::between(lowest, 1e9)));
  };
  result.max_windows = count("max_windows", result.max_windows, 0);
  result.min_windows = count("min_windows", result.min_windows, 0);
  result.check_windows = count("check_windows", result.check_windows, 1);
  result.tolerance = section.number_or("tolerance", result.tolerance, Range::positive());
  result.force_floor = section.number_or("force_floor_n", result.force_floor, Range::not_negative());
  result.qdem_residual_limit = section.number_or("qdem_residual_limit", result.qdem_residual_limit, Range::positive());
  result.fem_residual_limit = section.number_or("fem_residual_limit", result.fem_residual_limit, Range::positive());
  if (result.min_windows > result.max_windows) section.fail("min_windows", "min_windows is greater than max_windows");
  if (result.max_windows > 0 && result.max_windows <= result.check_windows)
    section.fail("max_windows", "rest is judged over the last " + std::to_string(result.check_windows) + " windows",
                 "allow more than check_windows");
  return result;
}

Iteration read_iteration(const Section& section) {
  Iteration result;
  const auto acceleration = section.choice_or("acceleration", "iqn_ils", {"constant", "aitken", "iqn_ils"});
  result.acceleration = acceleration == "constant" ? Iteration::Acceleration::constant
                        : acceleration == "aitken" ? Iteration::Acceleration::aitken
                                                   : Iteration::Acceleration::iqn_ils;
  result.relaxation = section.number_or("relaxation", result.relaxation, Range::between(1e-3, 2.0));
  result.force_tolerance = section.number_or("force_tolerance", result.force_tolerance, Range::positive());
  result.displacement_tolerance =
      section.number_or("displacement_tolerance", result.displacement_tolerance, Range::positive());
  result.max_iterations =
      static_cast<int>(section.integer_or("max_iterations", result.max_iterations, Range::between(1, 10000)));
  result.accept_at_limit = section.choice_or("at_limit", "stop", {"stop", "accept"}) == "accept";
  result.reused_windows =
      static_cast<int>(section.integer_or("reused_windows", result.reused_windows, Range::between(0, 1000)));
  result.filter = section.number_or("filter", result.filter, Range::between(0.0, 1.0));
  return result;
}

OneWay read_one_way(const Section& section) {
  OneWay result;
  if (section.has("history")) result.history = section.existing_path("history");
  if (section.has("support_stiffness_n_per_m"))
    result.support_stiffness = section.numbers("support_stiffness_n_per_m", 3, Range::positive());
  if (!result.history.empty() && !result.support_stiffness.empty())
    section.fail("support_stiffness_n_per_m", "a recorded rail needs no support", "remove this key or history");
  return result;
}

AuditLimits::Action read_action(const Section& section) {
  const auto action = section.choice_or("action", "warn", {"report", "warn", "switch", "stop"});
  return action == "report"   ? AuditLimits::Action::report
         : action == "warn"   ? AuditLimits::Action::warn
         : action == "switch" ? AuditLimits::Action::switch_scheme
                              : AuditLimits::Action::stop;
}

AuditLimits read_audit(const Section& section) {
  AuditLimits result;
  result.energy = section.number_or("energy", result.energy, Range::positive());
  result.momentum = section.number_or("momentum", result.momentum, Range::positive());
  result.moment = section.number_or("moment", result.moment, Range::positive());
  result.action = read_action(section);
  result.work_scale = section.number_or("work_scale_j", 0.0, Range::not_negative());
  result.impulse_scale = section.number_or("impulse_scale_n_s", 0.0, Range::not_negative());
  const bool acts = result.action == AuditLimits::Action::switch_scheme || result.action == AuditLimits::Action::stop;
  if (acts && !(result.work_scale > 0.0 && result.impulse_scale > 0.0))
    section.fail("action", "a run can be judged on its way only by scales of work and impulse",
                 "give work_scale_j and impulse_scale_n_s, say from the coupling.h5 of a run before");
  result.switch_to = scheme_of(section.choice_or("switch_to", "R2", scheme_names()));
  return result;
}

AdvisorInput read_advisor(const Section& section) {
  AdvisorInput result;
  result.rail_mass = section.number_or("rail_mass_kg", 0.0, Range::not_negative());
  result.sleeper_mass = section.number_or("sleeper_mass_kg", 0.0, Range::not_negative());
  result.accept_unstable = section.boolean_or("accept_unstable", false);
  return result;
}

CheckpointTimes read_checkpoint(const Section& section) {
  CheckpointTimes times;
  times.interval_windows = section.integer_or("interval_windows", 0, Range::between(0, most_windows));
  times.interval_s = section.number_or("interval_s", times.interval_s, Range::not_negative());
  return times;
}

}  // namespace

std::string why_no_switch(const Coupling& coupling) {
  const auto to = coupling.audit.switch_to;
  if (coupling.audit.action != AuditLimits::Action::switch_scheme || can_switch(coupling.scheme, to)) return {};
  return name_of(coupling.scheme) + " and " + name_of(to) + " load the rail in different ways";
}

Coupling read_coupling(const CaseFile& file) {
  const auto section = file.section("coupling");
  Coupling coupling;
  coupling.scheme = scheme_of(section.choice_or("scheme", "R1", scheme_names()));
  coupling.window_s = section.number_or("window_s", coupling.window_s, Range::positive());
  coupling.n_windows = read_window_count(section, coupling.window_s);
  coupling.sub_cycle_factor = static_cast<int>(section.integer_or("sub_cycle_factor", 1, Range::between(1, 1000)));
  coupling.output_interval_s = section.number_or("output_interval_s", 0.0, Range::not_negative());
  coupling.connect_timeout_s = section.number_or("connect_timeout_s", coupling.connect_timeout_s, Range::positive());
  coupling.stall_timeout_s = section.number_or("stall_timeout_s", coupling.stall_timeout_s, Range::positive());
  coupling.qdem = read_participant(section, "qdem");
  coupling.fem = read_participant(section, "fem");
  coupling.initialise = read_initialise(section.section("initialise"), coupling.window_s);
  coupling.prolongation = section.choice_or("prolongation", "linear", {"linear", "hermite"}) == "hermite"
                              ? Prolongation::hermite
                              : Prolongation::linear;
  coupling.iteration = read_iteration(section.section("iteration"));
  coupling.one_way = read_one_way(section.section("one_way"));
  coupling.audit = read_audit(section.section("audit"));
  if (const auto why = why_no_switch(coupling); !why.empty())
    section.section("audit").fail("switch_to", why, "R1 can switch to R2; E0, E1 and E2 to each other and to implicit");
  coupling.advisor = read_advisor(section.section("advisor"));
  coupling.checkpoint = read_checkpoint(section.section("checkpoint"));
  section.finish();
  return coupling;
}

}  // namespace proto
