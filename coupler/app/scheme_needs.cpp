#include "coupler/app/scheme_needs.hpp"

#include <fmt/format.h>

#include "coupler/mapping/interface_check.hpp"
#include "coupler/scheme/one_way.hpp"
#include "coupler/supervise/participant_start.hpp"

namespace coupler {
namespace {

namespace field = proto::field;

/// Under every interface value, the case's stand-in support shared by the cells.
std::vector<double> support_of_values(const CaseInput& input) {
  std::vector<double> support;
  if (input.coupling.one_way.support_stiffness.empty()) return support;
  for (const auto& seat : input.seats)
    for (int cell = 0; cell < seat.n_cells(); ++cell)
      for (const double whole : input.coupling.one_way.support_stiffness) support.push_back(whole / seat.n_cells());
  return support;
}

}  // namespace

void check_capabilities(const std::string& name, const proto::Capabilities& offered, const proto::Coupling& coupling) {
  const auto refuse = [&](const std::string& what, const std::string& advice) {
    throw ParticipantError(name, proto::ExitCode::config, fmt::format("{} does not offer {}", name, what), "set-up",
                           advice);
  };
  const auto& scheme = proto::name_of(coupling.scheme);
  if (coupling.initialise.max_windows > 0 && !offered.initialise)
    refuse("the initialise phase", "remove [coupling.initialise] from the case");
  if (proto::uses_robin(coupling.scheme) && name == "fem" && !offered.robin)
    refuse(fmt::format("the Robin condition that {} needs", scheme), "set coupling.scheme = \"E1\"");
  if (proto::needs_rollback(coupling.scheme) && !offered.rollback)
    refuse(fmt::format("the rollback that {} needs", scheme), "set coupling.scheme = \"R1\"");
  const bool may_switch = coupling.audit.action == proto::AuditLimits::Action::switch_scheme;
  if (may_switch && proto::needs_rollback(coupling.audit.switch_to) && !offered.rollback)
    refuse(fmt::format("the rollback that {} needs", proto::name_of(coupling.audit.switch_to)),
           "set another coupling.audit.action");
}

void check_registration(const std::string& name, const proto::Interface& registered, const CaseInput& input) {
  const auto& coupling = input.coupling;
  check_interface(name, registered, input.seats);
  if (name == "qdem")
    check_outgoing_fields(name, registered,
                          {field::impulse, field::pad_work, field::sleeper_displacement, field::sleeper_velocity});
  else
    check_outgoing_fields(name, registered, {field::rail_displacement, field::rail_velocity, field::force_used});
  if (name == "fem" && proto::uses_robin(coupling.scheme))
    check_outgoing_fields(name, registered, {field::force_robin});
  if (proto::is_rigid(coupling.scheme))
    check_taken_fields(name, registered, {field::joint_force_begin, field::joint_force},
                       fmt::format("scheme {}, which joins rigidly", proto::name_of(coupling.scheme)));
  if (name == "qdem" && coupling.prolongation == proto::Prolongation::hermite)
    check_taken_fields(name, registered, {field::path_velocity_begin, field::path_velocity},
                       "coupling.prolongation = \"hermite\"");
}

std::uint32_t first_sub_cycles(const proto::Coupling& coupling, std::optional<double> largest_step_s) {
  const auto wanted = sub_cycles_for(coupling.window_s, largest_step_s);
  if (coupling.scheme != proto::Scheme::rigid_per_step) return wanted;
  if (wanted > static_cast<std::uint32_t>(coupling.sub_cycle_factor))
    throw proto::Error(proto::ExitCode::config,
                       fmt::format("GC takes {} sub-cycles, qdem needs {}", coupling.sub_cycle_factor, wanted),
                       "set-up", "raise coupling.sub_cycle_factor");
  return 1;
}

proto::Configure configure_request(const std::string& name, const CaseInput& input, const std::string& out,
                                   std::vector<proto::PadLaw> laws) {
  if (name == "fem" && input.coupling.scheme == proto::Scheme::one_way)
    laws = stand_in_laws(std::move(laws), support_of_values(input));
  proto::Configure request;
  request.window_s = input.coupling.window_s;
  request.windows = input.coupling.n_windows;
  if (name == "qdem" && input.coupling.scheme == proto::Scheme::rigid_per_step) {
    // Every sub-step is a window of its own.
    request.window_s /= input.coupling.sub_cycle_factor;
    request.windows *= static_cast<std::uint64_t>(input.coupling.sub_cycle_factor);
  }
  const bool robin = proto::uses_robin(input.coupling.scheme);
  request.mode = robin ? proto::LoadMode::robin : proto::LoadMode::prescribed_force;
  request.output_directory = out;
  set_pad(request, laws);
  return request;
}

}  // namespace coupler
