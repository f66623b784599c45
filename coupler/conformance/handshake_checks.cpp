// Who the participant is and what it registers.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "coupler/conformance/check.hpp"
#include "coupler/conformance/subject.hpp"
#include "coupler/mapping/interface_check.hpp"
#include "coupler/scheme/coupling_scheme.hpp"

namespace coupler::conformance {
namespace {

namespace field = proto::field;

const std::map<std::string, std::string> units{{field::rail_displacement, "m"},
                                               {field::rail_displacement_begin, "m"},
                                               {field::rail_velocity, "m/s"},
                                               {field::rail_velocity_begin, "m/s"},
                                               {field::sleeper_displacement, "m"},
                                               {field::sleeper_velocity, "m/s"},
                                               {field::sleeper_mean_displacement, "m"},
                                               {field::sleeper_mean_velocity, "m/s"},
                                               {field::impulse, "N s"},
                                               {field::pad_work, "J"},
                                               {field::force_carry, "N"},
                                               {field::force_mean, "N"},
                                               {field::force_robin, "N"},
                                               {field::force_used, "N"}};

/// What it has to give at Start.
std::vector<std::string> motion_fields(const Candidate& candidate) {
  if (candidate.is_explicit()) return {field::sleeper_displacement, field::sleeper_velocity};
  return {field::rail_displacement, field::rail_velocity};
}

/// What it has to give in every window.
std::vector<std::string> window_fields(const Candidate& candidate, bool robin) {
  auto names = motion_fields(candidate);
  if (candidate.is_explicit()) names.insert(names.end(), {field::impulse, field::pad_work});
  if (!candidate.is_explicit()) names.push_back(field::force_used);
  if (!candidate.is_explicit() && robin) names.push_back(field::force_robin);
  return names;
}

std::string wrong_shape(const Subject& subject, const proto::Result& result, const std::vector<std::string>& names) {
  for (const auto& name : names) {
    if (!result.data.has(name)) return fmt::format("window {}: the field '{}' is missing", result.window, name);
    const auto& values = result.data.get(name);
    const auto n = subject.n_values_of(name);
    if (values.size() != n)
      return fmt::format("window {}: '{}' has {} values instead of {}", result.window, name, values.size(), n);
  }
  return {};
}

Verdict handshake(Bench& bench) {
  Subject subject(bench);
  subject.bring_to(Stage::connected);
  const auto& hello = subject.hello();
  return pass(fmt::format("{}, protocol {}.{}", hello.build_id.empty() ? "no build id" : hello.build_id,
                          hello.protocol_major, hello.protocol_minor));
}

Verdict rejection(Bench& bench) {
  Settings settings;
  settings.other_case = 1;
  Subject subject(bench, settings);
  const auto end = subject.ending(bench.candidate().coupling.connect_timeout_s);
  if (!end.exit || end.exit->signal || end.exit->code == 0) return fail("rejected for another case, it " + end.text());
  return pass(end.text());
}

/// The pad, by its owner only, as the case has it.
std::string wrong_pad(const Candidate& candidate, const proto::Interface& interface) {
  if (!candidate.is_explicit()) {
    for (const auto& seat : interface.seats)
      if (!seat.stiffness.empty()) return "it registers a pad, which is qdem's";
    return {};
  }
  const auto found = registered_pad(candidate.name, interface, candidate.seats);
  const auto wanted = proto::interface_laws(candidate.seats);
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (std::abs(found[i].stiffness - wanted[i].stiffness) > 1e-12 * wanted[i].stiffness ||
        std::abs(found[i].damping - wanted[i].damping) > 1e-12 * wanted[i].damping)
      return fmt::format("value {}: stiffness {} N/m, damping {} N s/m instead of the case's {} and {}", i,
                         found[i].stiffness, found[i].damping, wanted[i].stiffness, wanted[i].damping);
  return {};
}

Verdict units_and_shapes(Bench& bench) {
  const auto& candidate = bench.candidate();
  Subject subject(bench);
  subject.bring_to(Stage::registered);
  const auto& interface = subject.interface();
  const auto names = window_fields(candidate, subject.hello().capabilities.robin);
  check_outgoing_fields(candidate.name, interface, names);
  for (const auto& spec : interface.fields)
    if (const auto known = units.find(spec.name); known != units.end() && spec.unit != known->second)
      return fail(
          fmt::format("the field '{}' is registered in '{}' instead of '{}'", spec.name, spec.unit, known->second));
  if (const auto text = wrong_pad(candidate, interface); !text.empty()) return fail(text);
  subject.bring_to(Stage::marching);
  if (subject.initial().window != -1) return fail("the answer to Start is not of window -1");
  if (const auto text = wrong_shape(subject, subject.initial(), motion_fields(candidate)); !text.empty())
    return fail(text);
  for (std::int64_t window = 0; window < 3; ++window) {
    const auto result = subject.solve(subject.request());
    if (result.window != window || result.iteration != 0 || result.phase != proto::Phase::march)
      return fail(
          fmt::format("window {} is answered as window {} iteration {}", window, result.window, result.iteration));
    if (const auto text = wrong_shape(subject, result, names); !text.empty()) return fail(text);
    subject.commit();
  }
  return pass(fmt::format("{} fields registered, {} values each", interface.fields.size(),
                          subject.n_values_of(motion_fields(candidate).front())));
}

Verdict rigid_motion(Bench& bench) {
  Subject subject(bench);
  subject.bring_to(Stage::registered);
  check_interface(bench.candidate().name, subject.interface(), bench.candidate().seats);
  return pass("six motions, sums of force and moment, at 1e-12");
}

Verdict initialise(Bench& bench) {
  const auto& candidate = bench.candidate();
  const auto& initial = bench.reference();
  if (!initial.capabilities.initialise) return not_offered("no initialise phase");
  Subject subject(bench);
  subject.bring_to(Stage::configured);
  const double phase_window = candidate.coupling.initialise.window_s;
  const double window_s = phase_window > 0.0 ? phase_window : subject.window_s();
  const auto& configured = subject.configured();
  const auto step =
      configured.largest_initialise_step_s ? configured.largest_initialise_step_s : configured.largest_step_s;
  const Motion motion(subject.at_cells(initial.initial.data.get(motion_fields(candidate).front())),
                      proto::interface_laws(candidate.seats), window_s, candidate.amplitude_m);
  double residual = 0.0;
  for (std::int64_t n = 0; n < 3; ++n) {
    proto::Advance request{proto::Phase::initialise, n, 0, window_s, sub_cycles_for(window_s, step), {}};
    request.data = candidate.is_explicit()              ? motion.standing_rail()
                   : subject.hello().capabilities.robin ? motion.sleeper(0, 1.0)
                                                        : motion.force(0, 1.0);
    const auto result = subject.ask<proto::Result>(subject.on_wire(request));
    if (!result.residual) return fail(fmt::format("window {} has no residual", n));
    residual = *result.residual;
    if (residual < 0.0) return fail(fmt::format("window {} has the residual {}", n, residual));
    subject.send(proto::Commit{n});
  }
  const auto start = subject.ask<proto::Result>(proto::Start{});
  if (start.window != -1) return fail("the answer to Start is not of window -1");
  return pass(fmt::format("residual {:.2g} after three windows", residual));
}

}  // namespace

std::vector<Check> handshake_checks() {
  return {
      {"handshake", "connects, shows token, protocol, schema and case, takes the name given", Role::both, handshake},
      {"rejection", "ends by itself with a failure's code when it is rejected", Role::both, rejection},
      {"units_and_shapes", "registers and gives every field with its unit and length; the pad is qdem's", Role::both,
       units_and_shapes},
      {"rigid_motion", "its operator returns the rigid motions of a seat, keeps force and moment", Role::both,
       rigid_motion},
      {"initialise", "gives a residual in the initialise phase, which Start ends", Role::both, initialise}};
}

}  // namespace coupler::conformance
