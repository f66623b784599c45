#include "qdem_solver/participant/qdem_participant.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

#include "proto/case/coupling.hpp"
#include "proto/error.hpp"
#include "proto/result/provenance.hpp"
#include "proto/result/state_file.hpp"
#include "qdem_solver/engine/pads.hpp"
#include "qdem_solver/output/exchange.hpp"
#include "qdem_solver/participant/seat_registration.hpp"

namespace qdem {

namespace field = proto::field;

/// Of the last relaxation at true masses, with the rail held: many periods of the stones' own modes, which the scaled
/// inertia had slowed [s].
constexpr double release_time_s = 2e-3;

QdemParticipant::QdemParticipant(proto::CaseFile file, BedSource source, std::string name, std::string out)
    : file_(std::move(file)),
      source_(std::move(source)),
      name_(std::move(name)),
      out_(std::move(out)),
      energy_([](const std::string& line) { spdlog::warn("{}", line); }) {
  check_case(file_);
  output_interval_ = proto::read_coupling(file_).output_interval_s;
}

QdemParticipant::~QdemParticipant() = default;

std::string QdemParticipant::build_id() const {
  return "qdem_solver " + proto::project_version();
}

proto::Capabilities QdemParticipant::capabilities() const {
  proto::Capabilities capabilities;
  capabilities.rollback = capabilities.initialise = capabilities.save_restore = true;
  return capabilities;
}

proto::Interface QdemParticipant::describe() {
  bed_ = std::make_unique<TrackBed>(file_, source_, [this] {
    if (progress_ != nullptr) progress_->bump();
  });
  proto::Interface interface;
  for (const char* name : {field::rail_displacement_begin, field::rail_displacement}) {
    interface.fields.push_back({name, "m", 3, false});
  }
  for (const char* name : {field::rail_velocity_begin, field::rail_velocity}) {
    interface.fields.push_back({name, "m/s", 3, false});
  }
  interface.fields.push_back({field::sleeper_displacement, "m", 3, true});
  interface.fields.push_back({field::sleeper_velocity, "m/s", 3, true});
  interface.fields.push_back({field::impulse, "N s", 3, true});
  interface.fields.push_back({field::pad_work, "J", 3, true});
  interface.seats = register_seats(bed_->model(), bed_->state(), bed_->seats());
  return interface;
}

proto::Configured QdemParticipant::configure(const proto::Configure& request) {
  window_s_ = request.window_s;
  check_sensor_interval();
  if (!request.output_directory.empty()) out_ = request.output_directory;
  return {bed_->largest_step(), bed_->facts(), bed_->relaxation_step()};
}

proto::FieldSet QdemParticipant::values(PadSums sums) const {
  proto::FieldSet data;
  data.set(field::sleeper_displacement, bed_->pad_displacement());
  data.set(field::sleeper_velocity, bed_->pad_velocity());
  data.set(field::impulse, std::move(sums.impulse));
  data.set(field::pad_work, std::move(sums.work));
  return data;
}

void QdemParticipant::begin_window(const proto::Advance& request) {
  const bool relaxing = request.phase == proto::Phase::initialise;
  const double dt = request.window_s / request.sub_cycles;
  const double largest = relaxing ? bed_->relaxation_step() : committed_step_;
  if (dt > largest * (1 + 1e-9)) {
    throw proto::Error(proto::ExitCode::protocol,
                       fmt::format("{} sub-cycles make a step of {:.4g} s, the largest stable one is {:.4g} s",
                                   request.sub_cycles, dt, largest),
                       fmt::format("window {}", request.window), "see Result.largest_step_s in proto/README.md");
  }
  if (relaxing && !relaxing_) bed_->relax();
  relaxing_ = relaxing;
  before_window_ = bed_->state();
  if (relaxing) bed_->fit_inertia();
}

proto::FieldSet QdemParticipant::advance(const proto::Advance& request, proto::Progress&) {
  begin_window(request);
  const double dt = request.window_s / request.sub_cycles;
  const auto& begin = request.data.get(field::rail_displacement_begin);
  const auto& end = request.data.get(field::rail_displacement);
  rail_foot_ = end;
  auto sums = bed_->engine().advance(bed_->state(), dt, request.sub_cycles, {begin, end});
  if (marching_) {
    bed_->find_step(window_s_);
    above_bound_ = dt > bed_->step_bound();
  }
  return values(std::move(sums));
}

std::optional<double> QdemParticipant::largest_step() {
  return bed_->largest_step();
}

std::optional<double> QdemParticipant::residual() {
  return bed_->engine().unbalanced_ratio(bed_->state());
}

void QdemParticipant::check_sensor_interval() const {
  const SensorsSettings& sensors = bed_->settings().sensors;
  const double windows = sensors.interval / window_s_;
  if (sensors.list.empty() || std::abs(windows - std::round(windows)) < 1e-6 * windows) return;
  file_.section("qdem").fail("sensor_interval_s", fmt::format("it is {:.6g} windows of {:.4g} s", windows, window_s_),
                             "give a whole multiple of coupling.window_s");
}

RecordSettings QdemParticipant::record_settings() const {
  return {out_, output_interval_, bed_->attributes(file_)};
}

void QdemParticipant::commit(const proto::Commit& request) {
  committed_step_ = bed_->largest_step();
  if (!marching_) return;
  if (above_bound_) ++windows_above_bound_;
  record_->look(static_cast<double>(request.window + 1) * window_s_);
}

void QdemParticipant::rollback(const proto::Rollback&) {
  bed_->state() = before_window_;
}

proto::FieldSet QdemParticipant::start() {
  if (relaxing_) bed_->release(release_time_s, rail_foot_);
  bed_->begin_march();
  bed_->find_step(window_s_);
  committed_step_ = bed_->largest_step();
  marching_ = true;
  record_ = std::make_unique<BedRecord>(*bed_, energy_, record_settings());
  const std::vector<double> zero(3 * bed_->model().pads.size(), 0.0);
  return values({zero, zero});
}

void QdemParticipant::exchange(proto::StateArchive& archive) {
  archive.expect_same("bed", "the bed", bed_->bed_hash());
  qdem::exchange(archive, "state/", bed_->state());
  archive("committed_step", committed_step_);
  archive("windows_above_bound", windows_above_bound_);
  archive("rail_foot", rail_foot_);
}

std::uint64_t QdemParticipant::save(const proto::Save& request) {
  proto::StateWriter archive;
  exchange(archive);
  energy_.exchange(archive);
  record_->synchronise();
  record_->exchange(archive);
  return archive.write(request.path);
}

void QdemParticipant::restore(const proto::Restore& request) {
  proto::StateReader archive(request.path, request.hash);
  exchange(archive);
  energy_.exchange(archive);
  marching_ = true;
  record_ = std::make_unique<BedRecord>(*bed_, energy_, record_settings(), archive);
}

std::vector<proto::Fact> QdemParticipant::finish() {
  proto::StateWriter end;
  if (marching_) exchange(end);
  if (record_) record_->close();
  record_.reset();
  const auto contacts = bed_->engine().contacts().report(bed_->state());
  std::vector<proto::Fact> facts{{"qdem.end.state_hash", std::nullopt, fmt::format("{:016x}", end.hash())},
                                 {"qdem.end.coordination_number", contacts.coordination_number, {}},
                                 {"qdem.end.largest_penetration_m", contacts.largest_penetration, {}},
                                 {"qdem.windows_above_bound", static_cast<double>(windows_above_bound_), {}},
                                 {"qdem.steps", static_cast<double>(bed_->state().step), {}},
                                 {"qdem.candidate_rebuilds", static_cast<double>(bed_->state().contact.rebuilds), {}}};
  const bool stepped = !before_window_.x.empty();
  if (marching_ && stepped) energy_.look(bed_->engine(), bed_->state());
  const auto energy = energy_.facts();
  facts.insert(facts.end(), energy.begin(), energy.end());
  return facts;
}

}  // namespace qdem
