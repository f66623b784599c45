// The part of CoupledRun that saves and resumes.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "coupler/app/coupled_run.hpp"
#include "proto/clock.hpp"
#include "proto/result/provenance.hpp"
#include "proto/result/state_file.hpp"

namespace coupler {
namespace {

using Clock = std::chrono::steady_clock;

using proto::seconds_since;

/// Restored, what was warned of before comes first; what the resumed run has said again is there once.
void exchange_warnings(proto::StateArchive& archive, std::vector<std::string>& warnings) {
  std::string text = fmt::format("{}", fmt::join(warnings, "\n"));
  archive("warnings", text);
  if (!archive.restoring()) return;
  std::vector<std::string> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  for (const auto& now : warnings)
    if (std::find(all.begin(), all.end(), now) == all.end()) all.push_back(now);
  warnings = std::move(all);
}

}  // namespace

void CoupledRun::exchange(proto::StateArchive& archive) {
  // A run whose scheme was switched goes on with that one.
  archive("switched_to", summary_.switched_to);
  if (archive.restoring() && !summary_.switched_to.empty()) switch_scheme(proto::scheme_of(summary_.switched_to));
  archive.expect_same("scheme/name", "the scheme", proto::name_of(input_.coupling.scheme));
  scheme_->exchange(archive);
  judge_.exchange(archive);
  exchange_warnings(archive, summary_.warnings);
  coupler::exchange(archive, summary_.seats);
  std::uint64_t hash = hash_.value();
  archive("interface_hash", hash);
  hash_.set(hash);
  archive("initialise/windows", summary_.initialise_windows);
  archive("initialise/change", summary_.rest.change);
  archive("initialise/qdem_residual", summary_.rest.qdem_residual);
  archive("initialise/fem_residual", summary_.rest.fem_residual);
  archive("sub_cycles", summary_.sub_cycles);
}

bool CoupledRun::saves_at_all() const {
  const auto& times = input_.coupling.checkpoint;
  return times.interval_windows > 0 || times.interval_s > 0.0;
}

bool CoupledRun::save_is_due(std::int64_t window) const {
  const auto& times = input_.coupling.checkpoint;
  if (!can_save_) return false;
  if (times.interval_windows > 0 && (window + 1) % times.interval_windows == 0) return true;
  return times.interval_s > 0.0 && seconds_since(last_save_) >= times.interval_s;
}

void CoupledRun::save(std::int64_t window) {
  if (window == checkpointed_window_) return;
  supervisor_.set_stage(fmt::format("checkpoint after window {}", window));
  auto set = slots_.begin();
  auto& manifest = set.manifest;
  manifest.window = window;
  manifest.window_s = input_.coupling.window_s;
  manifest.case_path = input_.file.path();
  manifest.case_hash = input_.file.hash();
  manifest.version = proto::project_version();
  manifest.source = proto::source_description();
  manifest.builds = builds_;
  std::map<std::string, std::uint64_t> tickets;
  for (const auto& name : names_) tickets[name] = supervisor_.send(name, proto::Save{window, set.file(name)});
  for (const auto& [name, ticket] : tickets)
    manifest.hashes[name] = supervisor_.await<proto::Saved>(name, ticket, true).hash;
  record_->synchronise();
  proto::StateWriter own;
  exchange(own);
  record_->exchange(own);
  manifest.hashes["coupler"] = own.write(set.file("coupler"));
  CheckpointSlots::complete(set);
  summary_.checkpoint_window = checkpointed_window_ = window;
  last_save_ = Clock::now();
  log_.info("checkpoint after window {} in {}", window, set.folder);
}

void CoupledRun::check_builds(const Checkpoint& set, const std::set<std::string>& allowed) const {
  for (const auto& [name, was] : set.manifest.builds) {
    const auto is = builds_.find(name);
    if (is == builds_.end() || is->second == was) continue;
    log_.info("{} goes on from the state of another program: '{}', this is '{}'", name, was, is->second);
    if (allowed.count("program") == 0)
      throw proto::Error(
          proto::ExitCode::config,
          fmt::format("the checkpoint holds the state of another {}: '{}', this is '{}'", name, was, is->second),
          set.folder, "--allow program lets it take over if it can read that state");
  }
}

void CoupledRun::resume(const Checkpoint& set, const std::set<std::string>& allowed) {
  const auto& manifest = set.manifest;
  supervisor_.set_stage(fmt::format("resuming after window {}", manifest.window));
  if (!can_save_)
    throw proto::Error(proto::ExitCode::config, "a participant does not offer to restore a checkpoint",
                       supervisor_.stage());
  if (manifest.window_s != input_.coupling.window_s)
    throw proto::Error(proto::ExitCode::config,
                       fmt::format("the checkpoint was made with windows of {:g} s, the case has {:g} s",
                                   manifest.window_s, input_.coupling.window_s),
                       "coupling.window_s", "time is counted in windows: run the changed case from its beginning");
  for (const auto& name : names_)
    if (manifest.hashes.count(name) == 0)
      throw proto::Error(proto::ExitCode::config, "the checkpoint holds no state of " + name, set.folder);
  check_builds(set, allowed);
  std::map<std::string, std::uint64_t> tickets;
  for (const auto& name : names_)
    tickets[name] = supervisor_.send(name, proto::Restore{manifest.window, set.file(name), manifest.hashes.at(name)});
  for (const auto& [name, ticket] : tickets) supervisor_.await<proto::Restored>(name, ticket, true);
  slots_.forget_later(set);
  scheme_ = make_scheme(input_.coupling.scheme, input_.coupling, {input_.coupling.window_s, 1, laws_});
  proto::StateReader own(set.file("coupler"), manifest.hashes.at("coupler"));
  exchange(own);
  record_.emplace(folder_.file("coupling.h5"), input_.seats, input_.coupling.window_s, record_attributes(), own);
  next_window_ = manifest.window + 1;
  summary_.checkpoint_window = manifest.window;
  update_totals(next_window_);
  ++summary_.resumed;
  log_.info("resumed after window {} from {}", manifest.window, set.folder);
}

MarchEnd CoupledRun::early_end(std::optional<Clock::time_point> deadline) const {
  if (supervisor_.stop_requested()) return MarchEnd::stopped_by_user;
  if (deadline && Clock::now() >= *deadline) return MarchEnd::out_of_time;
  return MarchEnd::complete;
}

}  // namespace coupler
