#include "coupler/app/coupled_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "coupler/app/scheme_needs.hpp"
#include "coupler/launch/program_path.hpp"
#include "coupler/mapping/interface_check.hpp"
#include "coupler/report/status_view.hpp"
#include "coupler/scheme/rest_watch.hpp"
#include "coupler/supervise/participant_start.hpp"
#include "proto/clock.hpp"
#include "proto/result/provenance.hpp"

namespace coupler {
namespace {

namespace field = proto::field;
using Clock = std::chrono::steady_clock;
constexpr double grace_s = 1.5;                  // from SIGTERM to SIGKILL
constexpr const char* session_file = "session";  // of those who start a participant by hand

using proto::seconds_since;

/// Generous bound of one message: names, a few fields, the registered operators.
std::size_t largest_message(const std::vector<proto::RailSeat>& seats) {
  return 8 * sizeof(double) * 64 * proto::n_interface_values(seats) + (1u << 20);
}

std::vector<std::string> names_of(const CaseInput& input) {
  std::vector<std::string> names;
  for (const auto& spec : find_participants(input)) names.push_back(spec.name);
  return names;
}

}  // namespace

CoupledRun::CoupledRun(const CaseInput& input, const RunFolder& folder, spdlog::logger& log, Summary& summary,
                       StatusFile& status, const proto::Door& door)
    : input_(input),
      names_(names_of(input)),
      folder_(folder),
      log_(log),
      summary_(summary),
      status_(status),
      endpoint_(socket_folder_.path(), largest_message(input.seats), {names_, input.file.hash(), 1.0}, door),
      children_(own_path()),
      supervisor_(children_, endpoint_, patience_of(input.coupling)),
      qdem_(supervisor_, "qdem"),
      fem_(supervisor_, "fem"),
      rail_(&fem_),
      judge_(input, log, summary),
      slots_(folder.path()),
      can_save_(input.coupling.scheme != proto::Scheme::rigid_per_step),
      begin_(std::chrono::steady_clock::now()) {
  if (plays_recorded_rail(input.coupling)) {
    const double duration = static_cast<double>(input.coupling.n_windows) * input.coupling.window_s;
    recorded_.emplace(input.coupling.one_way.history, input.seats, duration);
    rail_ = &*recorded_;
  }
  supervisor_.on_long_set_up([this](const std::string& text) {
    fmt::print(stderr, "{}\n", text);
    update_wall_time();
    status_.now().note = text, status_.now().wall = summary_.wall;
    status_.write();
  });
  supervisor_.on_turned_away([this](const std::string& text) { log_.warn("{}", text); });
  for (const auto& seat : input.seats) summary_.seats.push_back({seat.name, 0.0, 0.0, 0.0});
  begin_phase("starting", 0);
}

CoupledRun::~CoupledRun() {
  children_.stop(grace_s);
  if (!input_.awaited.empty()) unlink(folder_.file(session_file).c_str());
}

void CoupledRun::record_frames() {
  auto path = folder_.file("frames.log");
  for (int i = 1; std::filesystem::exists(path); ++i) path = folder_.file(fmt::format("frames-{}.log", i));
  frames_.emplace(path);
  endpoint_.observe([this](const std::string& name, bool sent, proto::Span<const std::uint8_t> frame) {
    frames_->add(name, sent, frame);
  });
}

void CoupledRun::invite(const proto::ParticipantSpec& spec) {
  const auto& door = endpoint_.door_address();
  const auto& address = door.empty() ? endpoint_.address() : door;
  const auto path = folder_.file(session_file);
  // Lines that a shell can read.
  proto::write_private_file(
      path, fmt::format("QDEM_FEM_ENDPOINT='{}'\nQDEM_FEM_SESSION_TOKEN='{}'\n", address, endpoint_.session_token()));
  supervisor_.expect(spec.name, address);
  const auto text = fmt::format(
      "waiting at most {:g} s for {}, to be started with --endpoint {} and the token in {}: {} --case {} "
      "--out {} --name {}",
      input_.coupling.connect_timeout_s, spec.name, address, path, fmt::join(spec.command, " "), input_.file.path(),
      folder_.path(), spec.name);
  log_.info("{}", text);
  fmt::print(stderr, "coupler: {}\n", text);
}

void CoupledRun::start(int n_threads) {
  for (const auto& spec : find_participants(input_)) {
    if (input_.awaited.count(spec.name)) {
      invite(spec);
      continue;
    }
    auto child = participant_process(spec, input_.file.path(), endpoint_, folder_.path());
    if (n_threads > 0) child.environment.push_back({"OMP_NUM_THREADS", std::to_string(n_threads)});
    supervisor_.add(spec.name, spec.command.front(), child.log_path);
    children_.start(child);
    log_.info("started {}: {} (process {})", spec.name, fmt::join(spec.command, " "), children_.pid_of(spec.name));
  }
}

void CoupledRun::set_up() {
  for (const auto& [name, hello] : supervisor_.await_hellos()) {
    log_.info("{} connected, protocol {}.{}, build {}", name, hello.protocol_major, hello.protocol_minor,
              hello.build_id);
    check_capabilities(name, hello.capabilities, input_.coupling);
    can_save_ = can_save_ && hello.capabilities.save_restore;
    builds_[name] = hello.build_id;
  }
  supervisor_.set_stage("set-up");
  for (const auto& name : names_) {
    const auto registered = supervisor_.await<proto::Interface>(name, 0, true);
    check_registration(name, registered, input_);
    if (name == "qdem") laws_ = registered_pad(name, registered, input_.seats);
    if (name == "fem") map_rail(registered);
  }
  configure();
  summary_.wall.start_up = seconds_since(begin_);
  status_.now().note.clear();
  waited_in_start_up_s_ = supervisor_.waited_s();
  log_.info("configured: largest step {} s, {} s while initialising", configured_step_s_.value_or(0.0),
            initialise_step_s_.value_or(0.0));
  judge_.advise(laws_);
}

void CoupledRun::map_rail(const proto::Interface& registered) {
  auto map = map_to_pad("fem", registered, input_.seats);
  if (!map) return;
  for (const auto& note : map->notes()) map->carries_all_rigid_motions() ? log_.info("{}", note) : judge_.warn(note);
  mapped_.emplace(fem_, std::move(*map));
  rail_ = &*mapped_;
}

void CoupledRun::configure() {
  std::vector<std::uint64_t> tickets;  // all build their models at the same time
  for (const auto& name : names_) {
    auto request = configure_request(name, input_, folder_.path(), laws_);
    if (name == "fem" && mapped_) request.pad_map = mapped_->map().pad_map();
    tickets.push_back(supervisor_.send(name, std::move(request)));
  }
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const auto answer = supervisor_.await<proto::Configured>(names_[i], tickets[i], true);
    summary_.facts.insert(summary_.facts.end(), answer.facts.begin(), answer.facts.end());
    if (names_[i] != "qdem") continue;
    configured_step_s_ = answer.largest_step_s;
    initialise_step_s_ = answer.largest_initialise_step_s ? answer.largest_initialise_step_s : answer.largest_step_s;
  }
}

void CoupledRun::account(const WindowRecord& record) {
  summary_.wall.qdem += record.explicit_compute_s;
  summary_.wall.fem += record.implicit_compute_s;
}

void CoupledRun::initialise() {
  const auto& limits = input_.coupling.initialise;
  if (limits.max_windows == 0) return;
  RestWatch watch(limits);
  Progress progress("relaxing", limits.max_windows, limits.window_s);
  begin_phase("relaxing", limits.max_windows);
  auto coupling = input_.coupling;
  coupling.sub_cycle_factor = 1;  // only the state of rest counts
  const auto scheme = make_scheme(coupling.scheme, coupling,
                                  {limits.window_s, sub_cycles_for(limits.window_s, initialise_step_s_), laws_});
  bool at_rest = false;
  for (int n = 0; !at_rest && n < limits.max_windows; ++n) {
    supervisor_.set_stage(fmt::format("initialise window {}", n));
    const auto record = scheme->advance(proto::Phase::initialise, n, {*rail_, qdem_});
    scheme->commit(n, {*rail_, qdem_});
    account(record);
    const auto forces = seat_forces(record, input_.seats, limits.window_s);
    at_rest = watch.add({forces, record.explicit_residual, record.implicit_residual});
    summary_.initialise_windows = n + 1;
    summary_.rest = watch.figures();
    show(progress, {n + 1, limits.window_s, forces},
         fmt::format("changing by {:.1e}, residuals {:.1e} (qdem) {:.1e} (fem)", summary_.rest.change,
                     record.explicit_residual, record.implicit_residual));
  }
  if (!at_rest)
    throw proto::Error(proto::ExitCode::numerics,
                       fmt::format("the coupled system did not come to rest in {} windows; over the last {}: {}",
                                   limits.max_windows, limits.check_windows, watch.text()),
                       "initialise",
                       "raise coupling.initialise.max_windows, or the limit that is not met if it asks too much");
  log_.info("at rest after {} windows: {}", summary_.initialise_windows, watch.text());
}

InterfaceState CoupledRun::initial_values(std::optional<double>& largest_step_s) {
  std::uint64_t fem_ticket = 0;
  if (!recorded_) fem_ticket = supervisor_.send("fem", proto::Start{});
  const auto sleeper = supervisor_.await<proto::Result>("qdem", supervisor_.send("qdem", proto::Start{}));
  if (sleeper.largest_step_s) largest_step_s = sleeper.largest_step_s;
  InterfaceState initial;
  initial.sleeper_displacement = sleeper.data.get(field::sleeper_displacement);
  initial.sleeper_velocity = sleeper.data.get(field::sleeper_velocity);
  if (recorded_) {
    initial.rail_displacement = recorded_->initial_displacement();
    initial.rail_velocity = recorded_->initial_velocity();
    return initial;
  }
  auto rail = supervisor_.await<proto::Result>("fem", fem_ticket).data;
  if (mapped_) rail = at_cells(mapped_->map(), std::move(rail));
  initial.rail_displacement = rail.get(field::rail_displacement);
  initial.rail_velocity = rail.get(field::rail_velocity);
  return initial;
}

void CoupledRun::begin() {
  supervisor_.set_stage("start");
  auto step = configured_step_s_;
  const auto initial = initial_values(step);
  const double window_s = input_.coupling.window_s;
  scheme_ =
      make_scheme(input_.coupling.scheme, input_.coupling, {window_s, first_sub_cycles(input_.coupling, step), laws_});
  scheme_->start(initial);
  record_.emplace(folder_.file("coupling.h5"), input_.seats, window_s, record_attributes());
  record_->add_initial(initial);
}

proto::Attributes CoupledRun::record_attributes() const {
  auto attributes = proto::provenance("coupler", input_.file.name(), input_.file.hash(), input_.file.text());
  attributes.emplace_back("scheme", proto::name_of(input_.coupling.scheme));
  attributes.emplace_back("window_s", input_.coupling.window_s);
  for (const auto& fact : summary_.facts)
    attributes.emplace_back(fact.key, fact.number ? proto::Attribute(*fact.number) : proto::Attribute(fact.text));
  return attributes;
}

void CoupledRun::add_window(const WindowRecord& record) {
  const auto defects = judge_.add(record);
  record_->add(record, defects, judge_.audit());
  update_figures(summary_.seats, record, input_.seats, input_.coupling.window_s);
  hash_.add(record);
  summary_.sub_cycles = std::max(summary_.sub_cycles, record.sub_cycles);
  update_totals(record.window + 1);
}

void CoupledRun::begin_phase(const char* name, std::int64_t n_windows) {
  auto& now = status_.now();
  now.phase = name, now.n_windows_wanted = n_windows, now.n_windows = 0;
  now.seats.clear();
  status_.write();
}

void CoupledRun::show(Progress& progress, const WindowsDone& done, const std::string& note) {
  update_wall_time();
  auto& now = status_.now();
  const auto pace = progress.pace(done.n);
  now.n_windows = done.n, now.simulated_s = static_cast<double>(done.n) * done.window_s;
  now.windows_per_s = pace.windows_per_s, now.left_s = pace.left_s;
  now.energy_defect_relative = summary_.energy_defect_relative;
  now.momentum_defect_relative = summary_.momentum_defect_relative;
  now.wall = summary_.wall;
  now.seats.clear();
  double largest = 0.0;
  for (std::size_t i = 0; i < done.forces.size(); ++i) {
    now.seats.push_back({input_.seats[i].name, done.forces[i]});
    if (std::abs(done.forces[i]) > std::abs(largest)) largest = done.forces[i];
  }
  status_.renew();
  progress.update(done.n, fmt::format("seat force {:.2f} kN  {}  {}", largest / 1e3, note, wait_text(now.wall)));
}

void CoupledRun::update_totals(std::int64_t n_windows) {
  summary_.n_windows = n_windows;
  summary_.interface_hash = hash_.value();
  judge_.report();
}

void CoupledRun::switch_scheme(proto::Scheme to) {
  const auto& coupling = input_.coupling;
  auto next = make_scheme(to, coupling, {coupling.window_s, scheme_->state().sub_cycles, laws_});
  next->resume(scheme_->state());
  scheme_ = std::move(next);
}

MarchEnd CoupledRun::march(std::optional<Clock::time_point> deadline) {
  supervisor_.set_interruptible(false);
  const auto n_windows = static_cast<std::int64_t>(input_.coupling.n_windows);
  log_.info("marching through windows {} to {}", next_window_, n_windows - 1);
  const auto march_begin = last_save_ = Clock::now();
  const double window_s = input_.coupling.window_s;
  Progress progress("marching", n_windows, window_s, next_window_);
  begin_phase("marching", n_windows);
  for (auto n = next_window_; n < n_windows; n = next_window_) {
    if (const auto end = early_end(deadline); end != MarchEnd::complete) {
      if (can_save_ && n > 0) save(n - 1);
      supervisor_.set_stage(fmt::format("window {}", n));
      return end;
    }
    supervisor_.set_stage(fmt::format("window {}", n));
    const double window_begin_s = seconds_since(march_begin);
    auto record = scheme_->advance(proto::Phase::march, n, {*rail_, qdem_});
    record.begin_s = window_begin_s;
    record.end_s = seconds_since(march_begin);
    account(record);
    add_window(record);
    scheme_->commit(n, {*rail_, qdem_});
    next_window_ = n + 1;
    if (const auto next = judge_.judge(supervisor_.stage(), next_window_ == n_windows)) switch_scheme(*next);
    if (save_is_due(n)) save(n);
    show(progress, {n + 1, window_s, seat_forces(record, input_.seats, window_s)},
         fmt::format("defects {:.1e} (energy) {:.1e} (momentum)", summary_.energy_defect_relative,
                     summary_.momentum_defect_relative));
  }
  if (can_save_ && saves_at_all()) save(n_windows - 1);  // a longer run can go on from here
  judge_.observe();
  return MarchEnd::complete;
}

void CoupledRun::finish() {
  const auto facts = supervisor_.finish();
  summary_.facts.insert(summary_.facts.end(), facts.begin(), facts.end());
  if (record_) record_->close();
  if (frames_) {
    endpoint_.observe({});
    frames_->close();
  }
  update_wall_time();
}

void CoupledRun::update_wall_time() {
  auto& wall = summary_.wall;
  wall.total = seconds_since(begin_);
  const double waited = supervisor_.waited_s() - waited_in_start_up_s_;
  wall.waiting = std::max(0.0, waited - wall.qdem - wall.fem);
  wall.coupler = std::max(0.0, wall.total - wall.start_up - waited);
}

void CoupledRun::abandon(int code, const std::string& text) noexcept {
  supervisor_.abandon(code, text);
  children_.stop(grace_s);
  update_wall_time();
}

}  // namespace coupler
