#include "coupler/conformance/subject.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <string.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "coupler/launch/program_path.hpp"
#include "coupler/scheme/coupling_scheme.hpp"
#include "coupler/supervise/participant_start.hpp"
#include "proto/clock.hpp"
#include "proto/error.hpp"

namespace coupler::conformance {
namespace {

namespace field = proto::field;
using Clock = std::chrono::steady_clock;

constexpr std::size_t largest_message_bytes = 64u << 20;
constexpr std::uint64_t n_windows = 1000000000;

using proto::seconds_since;

/// Environment of a process; "" when it is gone or somebody else's.
std::string environment_of(const std::string& pid) {
  std::ifstream file("/proc/" + pid + "/environ", std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool is_defunct(const std::string& pid) {
  std::ifstream file("/proc/" + pid + "/stat");
  std::string text;
  std::getline(file, text);
  const auto end = text.rfind(')');
  return end == std::string::npos || text.compare(end, 3, ") Z") == 0;
}

std::string field_difference(const proto::Field& found, const proto::FieldSet& wanted) {
  if (!wanted.has(found.name)) return found.name + " is there in one answer only";
  const auto& other = wanted.get(found.name);
  if (other.size() != found.values.size()) return found.name + " has another length";
  for (std::size_t i = 0; i < other.size(); ++i)
    if (memcmp(&other[i], &found.values[i], sizeof(double)) != 0)
      return fmt::format("{} of value {} is {:.17g} instead of {:.17g}", found.name, i, found.values[i], other[i]);
  return {};
}

}  // namespace

std::string Ending::text() const {
  const auto end = exit ? exit->text() : std::string("still runs");
  return fmt::format("{} after {:.2f} s{}", end, seconds, fault ? ", its fault: " + fault->text : ", without a fault");
}

Subject::Subject(Bench& bench, const Settings& settings)
    : candidate_(bench.candidate()),
      settings_(settings),
      name_(candidate_.name),
      folder_(settings.folder.empty() ? bench.new_folder() : settings.folder),
      window_s_(candidate_.coupling.window_s * settings.window_share),
      children_(own_path()) {
  const proto::Admission admission{{name_}, candidate_.case_hash ^ settings.other_case, heartbeat_s};
  endpoint_ = std::make_unique<proto::CouplerEndpoint>(sockets_.path(), largest_message_bytes, admission);
  supervisor_ = std::make_unique<Supervisor>(children_, *endpoint_, patience_of(candidate_.coupling));
  token_ = endpoint_->session_token();
  const auto child = participant_process({name_, candidate_.command}, candidate_.case_path, *endpoint_, folder_);
  supervisor_->add(name_, child.command.front(), child.log_path);
  supervisor_->set_stage("conformance");
  children_.start(child);
}

Subject::~Subject() {
  children_.stop(0.0);
  for (const int pid : processes()) kill(pid, SIGKILL);
}

void Subject::bring_to(Stage stage) {
  while (!stage_ || *stage_ < stage) take_step();
}

/// One stage further.
void Subject::take_step() {
  if (!stage_) {
    hello_ = supervisor_->await_hellos().at(name_);
    stage_ = Stage::connected;
  } else if (*stage_ == Stage::connected) {
    interface_ = supervisor_->await<proto::Interface>(name_, 0, true);
    map_ = map_to_pad(name_, interface_, candidate_.seats);
    stage_ = Stage::registered;
  } else if (*stage_ == Stage::registered) {
    configure();
  } else if (*stage_ == Stage::configured) {
    begin(ask<proto::Result>(proto::Start{}));
  } else {
    solve(request());
  }
}

void Subject::configure() {
  mode_ =
      settings_.mode.value_or(hello_.capabilities.robin ? proto::LoadMode::robin : proto::LoadMode::prescribed_force);
  proto::Configure request;
  request.window_s = window_s_;
  request.windows = n_windows;
  request.mode = mode_;
  request.output_directory = folder_;
  set_pad(request, proto::interface_laws(candidate_.seats));
  if (map_) request.pad_map = map_->pad_map();
  configured_ = ask<proto::Configured>(request);
  step_s_ = configured_.largest_step_s;
  stage_ = Stage::configured;
}

void Subject::begin(const proto::Result& initial) {
  initial_ = initial;
  if (initial.largest_step_s) step_s_ = initial.largest_step_s;
  const auto& start =
      initial.data.get(candidate_.is_explicit() ? field::sleeper_displacement : field::rail_displacement);
  motion_.emplace(at_cells(start), proto::interface_laws(candidate_.seats), window_s_, candidate_.amplitude_m);
  stage_ = Stage::marching;
}

proto::Advance Subject::request(double scale) const {
  const auto sub_cycles = sub_cycles_for(window_s_, step_s_) * settings_.sub_cycle_factor;
  proto::Advance result{proto::Phase::march, window_, iteration_, window_s_, sub_cycles, {}};
  const bool robin = mode_ == proto::LoadMode::robin;
  result.data = candidate_.is_explicit() ? motion_->rail(window_, scale)
                : robin                  ? motion_->sleeper(window_, scale)
                                         : motion_->force(window_, scale);
  return on_wire(std::move(result));
}

std::vector<double> Subject::at_cells(const std::vector<double>& motion) const {
  return map_ ? map_->to_cells(motion) : motion;
}

proto::Advance Subject::on_wire(proto::Advance request) const {
  return map_ ? at_points(*map_, std::move(request)) : request;
}

std::size_t Subject::n_values_of(const std::string& name) const {
  if (!map_ || proto::belongs_to_pad(name, mode_)) return proto::n_interface_values(candidate_.seats);
  std::size_t n = 0;
  for (const auto& seat : interface_.seats) n += seat.points.size();
  return n;
}

proto::Result Subject::solve(const proto::Advance& request) {
  last_ = ask<proto::Result>(request);
  stage_ = Stage::advanced;
  return last_;
}

proto::Result Subject::solve(const proto::Advance& request, const std::function<void()>& look) {
  const auto ticket = send(request);
  const auto begin = Clock::now();
  std::optional<proto::Result> result;
  while (!result) {
    for (const auto& event : endpoint_->wait(0.02)) {
      const bool answers = event.message && event.message->in_reply_to == ticket;
      const auto* answer = answers ? std::get_if<proto::Result>(&event.message->body) : nullptr;
      if (!answer) throw ParticipantError(name_, proto::ExitCode::protocol, "no result came", event.problem);
      result = *answer;
    }
    if (!result && seconds_since(begin) > candidate_.coupling.stall_timeout_s)
      throw ParticipantError(name_, proto::ExitCode::unavailable, "no result came in time",
                             fmt::format("window {}", window_));
    children_.poll();
    if (const int signal = children_.stop_signal()) throw Interrupted(signal);
    look();
  }
  last_ = *result;
  stage_ = Stage::advanced;
  return last_;
}

void Subject::commit() {
  send(proto::Commit{window_});
  if (last_.largest_step_s) step_s_ = last_.largest_step_s;
  ++window_;
  iteration_ = 0;
  stage_ = Stage::marching;
}

void Subject::rollback() {
  send(proto::Rollback{window_});
  ++iteration_;
  stage_ = Stage::marching;
}

std::vector<proto::Result> Subject::march(int n) {
  std::vector<proto::Result> results;
  for (int i = 0; i < n; ++i) {
    results.push_back(solve(request()));
    commit();
  }
  return results;
}

Saving Subject::save() {
  Saving saving{window_ - 1, folder_ + "/" + name_ + "_saved.h5", folder_, 0, initial_, step_s_};
  saving.hash = ask<proto::Saved>(proto::Save{saving.window, saving.path}).hash;
  return saving;
}

void Subject::restore(const Saving& saving) {
  ask<proto::Restored>(proto::Restore{saving.window, saving.path, saving.hash});
  begin(saving.initial);
  step_s_ = saving.step_s;
  window_ = saving.window + 1;
}

std::vector<proto::Fact> Subject::finish() {
  return supervisor_->finish();
}

Ending Subject::ending(double limit_s) {
  Ending result;
  const auto begin = Clock::now();
  const auto listen = [&](double timeout_s) {
    if (!endpoint_) return children_.wait(timeout_s);
    for (const auto& event : endpoint_->wait(timeout_s, children_.fd()))
      if (const auto* fault = event.message ? std::get_if<proto::Fault>(&event.message->body) : nullptr)
        result.fault = *fault;
    children_.poll();
  };
  while (!result.exit && seconds_since(begin) < limit_s) {
    listen(0.05);
    if (const int signal = children_.stop_signal()) throw Interrupted(signal);
    result.exit = children_.exit_of(name_);
  }
  result.seconds = seconds_since(begin);
  listen(0.05);  // its last words may be read after its end
  return result;
}

void Subject::kill_process() const {
  kill(children_.pid_of(name_), SIGKILL);
}

std::vector<int> Subject::processes() const {
  const auto mark = "=" + token_;
  std::vector<int> result;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const auto pid = entry.path().filename().string();
    if (pid.find_first_not_of("0123456789") != std::string::npos) continue;
    if (environment_of(pid).find(mark) != std::string::npos && !is_defunct(pid)) result.push_back(std::stoi(pid));
  }
  return result;
}

std::string difference(const proto::Result& found, const proto::Result& wanted) {
  if (found.data.all().size() != wanted.data.all().size()) return "another number of fields came";
  for (const auto& values : found.data.all())
    if (const auto text = field_difference(values, wanted.data); !text.empty())
      return fmt::format("window {}: {}", found.window, text);
  if (found.largest_step_s != wanted.largest_step_s)
    return fmt::format("window {}: largest_step_s is {:.17g} instead of {:.17g}", found.window,
                       found.largest_step_s.value_or(0.0), wanted.largest_step_s.value_or(0.0));
  return {};
}

}  // namespace coupler::conformance
