// What the coupler takes from a case file.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "proto/case/case_file.hpp"
#include "proto/case/coupling.hpp"
#include "proto/case/rail_seat.hpp"

namespace coupler {

struct CaseInput {
  proto::CaseFile file;
  proto::Coupling coupling;
  std::vector<proto::RailSeat> seats;
  std::set<std::string> awaited;  ///< participants that somebody else starts
};

/// Only the coupler sees the case as a whole; what is inside a solver's section is for that solver to check. Throws
/// proto::Error (config).
void refuse_unknown_sections(const proto::CaseFile& file);

/// Reads and checks the coupler's own and the common sections. Throws proto::Error (config, missing_input).
CaseInput read_case(const std::string& path);

/// Puts other programs in the place of the case's fem_command ("solid": fem_solver, "beam": fem_beam, or one of the
/// user's) and qdem_command, started with `participant` as their first argument. Empty: the case's stays.
/// Throws proto::Error (missing_input) when there is no such program.
void use_programs(proto::Coupling& coupling, const std::string& fem, const std::string& qdem);

/// The participants' programs as absolute paths, in the order qdem, fem. Those of awaited ones are left as they are.
/// Throws proto::Error (missing_input) naming the key of the program that is not there.
std::vector<proto::ParticipantSpec> find_participants(const CaseInput& input);

}  // namespace coupler
