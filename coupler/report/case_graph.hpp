// Who takes part in a coupled case, and what goes between them.
#pragma once

#include <string>
#include <vector>

#include "proto/case/coupling.hpp"
#include "proto/case/rail_seat.hpp"

namespace coupler {

/// A graph in Graphviz' language: participants, coupler and scheme, rail seats with their pads, files.
std::string case_graph(const std::string& name, const proto::Coupling& coupling,
                       const std::vector<proto::RailSeat>& seats);

}  // namespace coupler
