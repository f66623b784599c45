// `fem_solver contact CASE`: one contact of wheel and rail, printed and written.
#pragma once

#include <string>

namespace fem {

/// Reads `[contact]` of the case at `path`, prints patch, pressure, resultants, a map of stick and slip and the
/// creep-force curve, and writes `out`/contact.h5 as `program`. Throws proto::Error.
void run_contact(const std::string& path, const std::string& program, const std::string& out);

}  // namespace fem
