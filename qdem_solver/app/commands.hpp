// The commands a person types; what they print goes to stdout.
#pragma once

#include <string>

namespace qdem {

/// `qdem_solver run`: bed and [qdem.run], then a table of figures. `out` is created when missing.
void run_command(const std::string& case_path, const std::string& out);

/// `qdem_solver bed`: builds the bed (or takes it from the cache), writes it to `path`, prints its figures.
void bed_command(const std::string& case_path, const std::string& path);

}  // namespace qdem
