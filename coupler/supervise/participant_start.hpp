// How a participant is started and configured, whoever plays the coupler to it.
#pragma once

#include <string>
#include <vector>

#include "coupler/launch/children.hpp"
#include "coupler/supervise/supervisor.hpp"
#include "proto/case/coupling.hpp"
#include "proto/pad/pad_law.hpp"
#include "proto/session/coupler_endpoint.hpp"
#include "proto/wire/messages.hpp"

namespace coupler {

/// Waits as long as the case says.
Patience patience_of(const proto::Coupling& coupling);

/// The process of participant `spec` (its program as an absolute path) with the arguments of proto/README.md "Starting
/// a participant"; output and log in `folder`, which exists.
ChildSpec participant_process(const proto::ParticipantSpec& spec, const std::string& case_path,
                              const proto::CouplerEndpoint& endpoint, const std::string& folder);

/// Puts the law of every interface value into `request`.
void set_pad(proto::Configure& request, const std::vector<proto::PadLaw>& laws);

}  // namespace coupler
