#include "coupler/app/case_input.hpp"

#include "coupler/launch/program_path.hpp"

namespace coupler {

void refuse_unknown_sections(const proto::CaseFile& file) {
  file.refuse_unknown_sections({"coupling", "track", "rail_seat", "bed", "qdem", "fem", "wheel", "oscillator"});
}

CaseInput read_case(const std::string& path) {
  auto file = proto::CaseFile::load(path);
  refuse_unknown_sections(file);
  auto coupling = proto::read_coupling(file);
  auto seats = proto::read_rail_seats(file);
  return {std::move(file), std::move(coupling), std::move(seats), {}};
}

void use_programs(proto::Coupling& coupling, const std::string& fem, const std::string& qdem) {
  const std::string program = fem == "solid" ? "fem_solver" : fem == "beam" ? "fem_beam" : fem;
  if (!fem.empty()) coupling.fem.command = {find_program(program, "--fem"), "participant"};
  if (!qdem.empty()) coupling.qdem.command = {find_program(qdem, "--qdem"), "participant"};
}

std::vector<proto::ParticipantSpec> find_participants(const CaseInput& input) {
  std::vector<proto::ParticipantSpec> result{input.coupling.qdem};
  if (!plays_recorded_rail(input.coupling)) result.push_back(input.coupling.fem);
  for (auto& spec : result) {
    if (input.awaited.count(spec.name)) continue;
    spec.command.front() =
        find_program(spec.command.front(), input.file.path() + ": coupling." + spec.name + "_command");
  }
  return result;
}

}  // namespace coupler
