#include "coupler/app/kit_candidate.hpp"

#include <cstdlib>
#include <filesystem>

#include "coupler/app/case_input.hpp"
#include "coupler/launch/program_path.hpp"
#include "proto/error.hpp"

namespace coupler {

namespace fs = std::filesystem;

conformance::Candidate find_candidate(const std::string& case_path, const std::string& name,
                                      const std::vector<std::string>& command) {
  const auto input = read_case(case_path);
  conformance::Candidate candidate;
  candidate.name = name;
  candidate.coupling = input.coupling;
  candidate.seats = input.seats;
  candidate.case_path = fs::absolute(input.file.path()).string();
  candidate.case_hash = input.file.hash();
  const auto& of_case = name == "qdem" ? input.coupling.qdem : input.coupling.fem;
  candidate.command = command.empty() ? of_case.command : command;
  candidate.command.front() = find_program(candidate.command.front(), "the command of the participant");
  return candidate;
}

Workplace::Workplace(const std::string& wanted) : own_(wanted.empty()), path_(wanted) {
  if (own_) path_ = (fs::temp_directory_path() / "conformance-XXXXXX").string();
  std::error_code error;
  const bool made = own_ ? mkdtemp(path_.data()) != nullptr : fs::create_directory(path_, error);
  if (!made)
    throw proto::Error(proto::ExitCode::cannot_create, "the output folder cannot be made", path_,
                       "--out must name a folder that is not there yet");
  path_ = fs::absolute(path_).string();
}

Workplace::~Workplace() {
  std::error_code ignored;
  if (own_ && !keep_) fs::remove_all(path_, ignored);
}

}  // namespace coupler
