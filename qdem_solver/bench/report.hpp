// `qdem_solver bench`: rates beside what the machine could do.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "qdem_solver/bench/scenes.hpp"

namespace qdem::bench {

/// Measures; takes about a minute a core. `settled`: a bed at rest, for the cost of whole steps with contact; without,
/// the pile of boxes serves. README.md explains every key.
nlohmann::ordered_json measure(const Scene* settled);

/// The same as text for people.
std::string table(const nlohmann::ordered_json& report);

}  // namespace qdem::bench
