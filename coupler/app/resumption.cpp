#include "coupler/app/resumption.hpp"

#include <fmt/format.h>

#include "proto/error.hpp"
#include "proto/result/provenance.hpp"

namespace coupler {
namespace {

using proto::Error;
using proto::ExitCode;

std::string program_of(const std::string& version, const std::string& source) {
  return version + " (" + source + ")";
}

void check_version(const Manifest& manifest, const std::set<std::string>& allowed) {
  const auto was = program_of(manifest.version, manifest.source);
  const auto is = program_of(proto::project_version(), proto::source_description());
  if (was == is || allowed.count("version") > 0) return;
  throw Error(ExitCode::config, "the checkpoint was made by another version of the program: " + was + ", this is " + is,
              "", "--allow version takes it all the same; the bits need not come out as without the interruption");
}

void check_case(const proto::CaseFile& before, const proto::CaseFile& now, const std::set<std::string>& allowed) {
  if (before.hash() == now.hash() || allowed.count("case") > 0) return;
  const auto differences = before.differences_to(now);
  if (differences.empty()) return;  // comments and layout
  throw Error(ExitCode::config,
              fmt::format("the case was changed since the run began: {}", fmt::join(differences, "; ")), now.path(),
              "--allow case goes on with the changed one");
}

/// The text that made the set lies in the folder as case.toml: a set from elsewhere does not belong to it.
void check_origin(const Checkpoint& set, const proto::CaseFile& before, const std::set<std::string>& allowed) {
  if (set.manifest.case_hash == before.hash() || allowed.count("case") > 0) return;
  throw Error(ExitCode::config, "the checkpoint was made with another case than the folder's", set.folder,
              "--allow case takes it all the same");
}

Checkpoint newest_set(const RunFolder& folder) {
  std::vector<std::string> problems;
  auto set = CheckpointSlots(folder.path()).newest(problems);
  for (const auto& problem : problems) fmt::print(stderr, "coupler: {}\n", problem);
  if (!set)
    throw Error(ExitCode::missing_input, "there is no checkpoint to go on from", folder.path(),
                "runs save one when they are stopped and every coupling.checkpoint.interval_s");
  return std::move(*set);
}

}  // namespace

Resumption find_resumption(const RunFolder& folder, const std::string& case_path,
                           const std::set<std::string>& allowed) {
  auto set = newest_set(folder);
  auto input = read_case(case_path.empty() ? set.manifest.case_path : case_path);
  check_version(set.manifest, allowed);
  const auto before = proto::CaseFile::load(folder.file("case.toml"));
  check_origin(set, before, allowed);
  check_case(before, input.file, allowed);
  return {std::move(input), std::move(set)};
}

}  // namespace coupler
