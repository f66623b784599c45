// The commands a person types; what they print goes to stdout.
#pragma once

#include <string>

#include "proto/case/case_file.hpp"
#include "qdem_solver/bed/bed.hpp"
#include "qdem_solver/bed/rough_surface.hpp"

namespace qdem {

/// `qdem_solver check`: every section that this program reads. Throws proto::Error (config).
void check_command(const proto::CaseFile& file);

/// Prints the JSON Schema of the sections that this program reads.
void schema_command();

/// Prints what the case's sleeper weighs, the step it allows, and the contact's stiffness on pad and ground.
void print_figures(const proto::CaseFile& file);

/// The bed of the case, built or from the cache.
Bed bed_of_case(const proto::CaseFile& file, const BedPhysics& physics);

/// `qdem_solver run`: bed and [qdem.run], then a table of figures. `out` is created when missing.
void run_command(const std::string& case_path, const std::string& out);

/// `qdem_solver bed`: builds the bed (or takes it from the cache), writes it to `path`, and its fields for ParaView to
/// NAME_fields.h5 beside it; prints its figures.
void bed_command(const std::string& case_path, const std::string& path);

/// `qdem_solver bench`: rates of this machine and of the solver on it, as a table and, with `json_path` not empty, in a
/// file. With `case_path` not empty the costs of contact are those of its bed.
void bench_command(const std::string& case_path, const std::string& json_path);

/// `qdem_solver bench --cuda`: rates of the CUDA engine, as a table. Throws proto::Error (unavailable) without a
/// device.
void device_bench_command();

/// `qdem_solver stones`: the case's stone templates as STL files in `folder`, which is created when missing.
void stones_command(const std::string& case_path, const std::string& folder, const bed::Roughness& roughness);

}  // namespace qdem
