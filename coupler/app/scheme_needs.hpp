// What the scheme of a case asks of the participants, before any window.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coupler/app/case_input.hpp"
#include "proto/wire/messages.hpp"

namespace coupler {

/// What the case asks for must have been offered in Hello. Throws ParticipantError (config) with a way out.
void check_capabilities(const std::string& name, const proto::Capabilities& offered, const proto::Coupling& coupling);

/// Interface, operators and fields that the scheme needs. Throws proto::Error (protocol, config).
void check_registration(const std::string& name, const proto::Interface& registered, const CaseInput& input);

/// Sub-cycles of the first window of the march before they are multiplied by sub_cycle_factor. GC takes exactly
/// sub_cycle_factor of them, as both sides have to know before any step is named. Throws proto::Error (config) when
/// those are too few, (numerics) as sub_cycles_for() does.
std::uint32_t first_sub_cycles(const proto::Coupling& coupling, std::optional<double> largest_step_s);

/// Configure for `name`. `laws`: the pad as registered. One way, the rail's side gets its stand-in supports.
proto::Configure configure_request(const std::string& name, const CaseInput& input, const std::string& out,
                                   std::vector<proto::PadLaw> laws);

}  // namespace coupler
