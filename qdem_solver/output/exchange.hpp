// A State on its way into a file and back.
#pragma once

#include <string>

#include "proto/result/state_archive.hpp"
#include "qdem_solver/state/state.hpp"

namespace qdem {

/// All of `state`, under names that begin with `prefix`. Its arrays must fit the model that it is used with.
void exchange(proto::StateArchive& archive, const std::string& prefix, State& state);

/// Its contacts alone.
void exchange(proto::StateArchive& archive, const std::string& prefix, ContactState& contact);

}  // namespace qdem
