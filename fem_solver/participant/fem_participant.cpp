#include "fem_solver/participant/fem_participant.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "fem_solver/assembly/cell_operator.hpp"
#include "proto/result/provenance.hpp"
#include "proto/result/state_file.hpp"

namespace fem {
namespace {

namespace field = proto::field;

Eigen::VectorXd vector(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<double> values(const Eigen::VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

proto::Fact fact(const std::string& key, double number) {
  return {key, number, ""};
}

}  // namespace

FemCase read_fem_case(const std::string& path) {
  auto file = proto::CaseFile::load(path);
  auto coupling = proto::read_coupling(file);
  auto seats = proto::read_rail_seats(file);
  auto fem = read_fem(file, seats);
  auto wheel = read_wheel(file, fem.material);
  windows_per_output(coupling.output_interval_s, coupling.window_s);
  return {std::move(file), std::move(coupling), std::move(seats), std::move(fem), std::move(wheel)};
}

std::vector<proto::Fact> model_facts(const RailModel& rail, const FemSettings& settings) {
  const RailFigures figures = rail.figures();
  const SectionProperties& section = figures.section;
  return {fact("fem.unknowns", rail.track().n_dofs()),
          fact("fem.elements", figures.n_elements),
          fact("fem.element_length_m", figures.element_length),
          fact("fem.rail_length_m", figures.length),
          fact("fem.section_area_m2", section.area),
          fact("fem.section_centroid_m", section.centroid_height),
          fact("fem.section_inertia_vertical_m4", section.inertia_vertical),
          fact("fem.section_inertia_lateral_m4", section.inertia_lateral),
          fact("fem.rail_mass_kg_per_m", section.area * settings.material.density),
          fact("fem.seat_mass_kg", section.area * settings.material.density * settings.sleeper_spacing)};
}

FemParticipant::FemParticipant(FemCase input, std::string program, std::string name, const RailBuilder& build,
                               WheelBuilder build_wheel)
    : input_(std::move(input)),
      program_(std::move(program)),
      name_(std::move(name)),
      rail_(build(input_.fem, input_.seats, SeatOwner::partner)),
      build_wheel_(std::move(build_wheel)) {}

std::string FemParticipant::build_id() const {
  return program_ + " " + proto::project_version();
}

proto::Capabilities FemParticipant::capabilities() const {
  proto::Capabilities can;
  can.robin = can.rollback = can.initialise = can.save_restore = true;
  return can;
}

void FemParticipant::bump() const {
  if (progress_) progress_->bump();
}

proto::Interface FemParticipant::describe() {
  bump();
  const auto& seats = rail_->track().coupled_seats;
  return {{{field::sleeper_mean_displacement, "m", 3, false},
           {field::sleeper_mean_velocity, "m/s", 3, false},
           {field::force_carry, "N", 3, false},
           {field::force_mean, "N", 3, false},
           {field::rail_displacement, "m", 3, true},
           {field::rail_velocity, "m/s", 3, true},
           {field::force_robin, "N", 3, true},
           {field::force_used, "N", 3, true}},
          CellOperator(rail_->kinematics(), seats).registration(rail_->kinematics(), seats)};
}

proto::Configured FemParticipant::configure(const proto::Configure& request) {
  bump();
  const auto n = static_cast<std::size_t>(rail_->track().cells.rows());
  if (request.stiffness.size() != n || request.damping.size() != n || request.preload.size() != n ||
      request.tension_cutoff.size() != n)
    throw proto::Error(proto::ExitCode::protocol, "Configure does not give the pad of every interface value",
                       "stiffness, damping, preload, tension_cutoff", "the side that owns the pad registers them");
  std::vector<proto::PadLaw> laws;
  for (std::size_t i = 0; i < n; ++i)
    laws.push_back({request.stiffness[i], request.damping[i], request.preload[i], request.tension_cutoff[i]});
  mode_ = request.mode;
  track_ = std::make_unique<WheelTrack>(*rail_, input_.fem, input_.wheel, build_wheel_(input_.wheel), request.window_s,
                                        std::move(laws));
  bump();
  track_->band().at(track_->position_at(static_cast<double>(request.windows)));
  output_directory_ = request.output_directory;
  window_s_ = request.window_s;
  smallest_contact_ = largest_contact_ = input_.wheel.static_load;
  committed_ = track_->state();
  auto facts = model_facts(*rail_, input_.fem);
  facts.push_back(fact("fem.factor_entries", track_->n_factor_entries()));
  facts.push_back(fact("fem.local_indentation_m_per_n", track_->indentation()));
  facts.push_back(fact("fem.hertz_stiffness_n_per_m", track_->hertz().at_force(input_.wheel.static_load).stiffness));
  return {std::nullopt, std::move(facts)};
}

WindowInput FemParticipant::window_input(const proto::FieldSet& data) const {
  WindowInput input;
  if (mode_ == proto::LoadMode::prescribed_force) {
    input.prescribed = vector(data.get(field::force_mean));
    return input;
  }
  input.sleeper_displacement = vector(data.get(field::sleeper_mean_displacement));
  input.sleeper_velocity = vector(data.get(field::sleeper_mean_velocity));
  input.carry = vector(data.get(field::force_carry));
  return input;
}

proto::FieldSet FemParticipant::motion() const {
  proto::FieldSet data;
  data.set(field::rail_displacement, values(track_->cell_displacement()));
  data.set(field::rail_velocity, values(track_->cell_velocity()));
  return data;
}

proto::FieldSet FemParticipant::advance(const proto::Advance& request, proto::Progress& progress) {
  const WindowInput input = window_input(request.data);
  phase_ = request.phase;
  WindowOutput output;
  if (phase_ == proto::Phase::march) {
    output = track_->march(input);
  } else {
    // The first relaxation begins from the static state on the sleeper as it stands.
    if (!relaxed_ && !input.prescribed) track_->rest(input.sleeper_displacement);
    relaxed_ = true;
    output = track_->relax(input, request.window_s);
  }
  progress.bump();
  force_used_ = output.force_used;
  proto::FieldSet data = motion();
  data.set(field::force_used, values(output.force_used));
  data.set(field::force_robin, values(output.force_robin));
  return data;
}

void FemParticipant::commit(const proto::Commit&) {
  committed_ = track_->state();
  if (phase_ != proto::Phase::march) return;
  largest_contact_ = std::max(largest_contact_, track_->contact_force());
  smallest_contact_ = std::min(smallest_contact_, track_->contact_force());
  lowest_wheel_ = std::min(lowest_wheel_, committed_.wheel.hub());
  record_->window(*track_);
}

void FemParticipant::rollback(const proto::Rollback&) {
  track_->set_state(committed_);
}

template <class... Saved>
void FemParticipant::open_record(Saved&... saved) {
  record_ = std::make_unique<FemRecord>(output_directory_, program_, input_.file, *rail_, *track_, window_s_,
                                        windows_per_output(input_.coupling.output_interval_s, window_s_), saved...);
}

proto::FieldSet FemParticipant::start() {
  track_->start();
  committed_ = track_->state();
  if (force_used_.size() == 0) force_used_ = Eigen::VectorXd::Zero(track_->cell_displacement().size());
  open_record();
  record_->begin(*track_);
  proto::FieldSet data = motion();
  data.set(field::force_robin, values(force_used_));
  data.set(field::force_used, values(force_used_));
  return data;
}

void FemParticipant::exchange(proto::StateArchive& archive) {
  archive.expect_same("model", "the rail", std::to_string(rail_->track().n_dofs()) + " unknowns");
  archive.expect_same("wheel_model", "the wheel", std::to_string(track_->wheel_model().n_dofs()) + " unknowns");
  fem::exchange(archive, committed_);
  archive("force_used", force_used_);
  archive("largest_contact", largest_contact_);
  archive("smallest_contact", smallest_contact_);
  archive("lowest_wheel", lowest_wheel_);
}

std::uint64_t FemParticipant::save(const proto::Save& request) {
  proto::StateWriter archive;
  exchange(archive);
  record_->synchronise();
  record_->exchange(archive);
  return archive.write(request.path);
}

void FemParticipant::restore(const proto::Restore& request) {
  proto::StateReader archive(request.path, request.hash);
  track_->start();
  exchange(archive);
  track_->set_state(committed_);
  phase_ = proto::Phase::march;
  open_record(archive);
}

std::vector<proto::Fact> FemParticipant::finish() {
  proto::StateWriter end;
  if (record_) {
    exchange(end);
    record_->close();
  }
  return {{"fem.end.state_hash", std::nullopt, fmt::format("{:016x}", end.hash())},
          fact("fem.largest_contact_force_n", largest_contact_),
          fact("fem.smallest_contact_force_n", smallest_contact_),
          fact("fem.lowest_wheel_displacement_m", lowest_wheel_)};
}

}  // namespace fem
