// `fem_solver contact CASE`: one contact of wheel and rail, printed and written.
#pragma once

#include <functional>
#include <string>

#include "fem_solver/contact/contact_analysis.hpp"

namespace fem {

/// Solves a contact of solid elements.
using ContactAnalyser = std::function<ContactResult(const ContactCase&)>;

/// Reads `[contact]` of the case at `path`, prints patch, pressure, resultants, a map of stick and slip and the
/// creep-force curve, and writes `out`/contact.h5 as `program`. `blocks`: for bodies = "blocks", none where the program
/// has no such elements. Throws proto::Error.
void run_contact(const std::string& path, const std::string& program, const ContactAnalyser& blocks,
                 const std::string& out);

}  // namespace fem
