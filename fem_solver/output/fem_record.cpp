#include "fem_solver/output/fem_record.hpp"

#include <algorithm>
#include <cmath>

#include "proto/result/provenance.hpp"

namespace fem {
namespace {

using proto::Location;

proto::OutputMesh output_mesh(RailShape shape) {
  const auto type = shape.nodes_per_cell == 8 ? proto::CellType::hexahedron : proto::CellType::line;
  return proto::OutputMesh::of_one_type(std::move(shape.points), std::move(shape.connectivity), type);
}

// At the end of the window.
const std::vector<proto::Column> patch_histories = {
    {"wheel/longitudinal_force", "N", "shear of the contact on the wheel", {}},
    {"wheel/lateral_force", "N", "shear of the contact on the wheel", {}},
    {"wheel/spin_moment", "N m", "shear of the contact on the wheel, about the normal", {}},
    {"wheel/longitudinal_creepage", "1", "of the wheel over the rail, negative where it drives", {}},
    {"wheel/patch_area", "m2", "elements with pressure", {}},
    {"wheel/stick_share", "1", "of the patch's area", {}}};

proto::FieldSeriesOptions file_options(const std::string& program, const proto::CaseFile& file, const RailModel& rail,
                                       const WheelTrack& track, const std::vector<RailField>& fields) {
  proto::FieldSeriesOptions options;
  options.mesh = output_mesh(rail.shape());
  for (const auto& field : fields)
    options.fields.push_back({field.name, field.unit, field.description,
                              field.per_point ? Location::point : Location::cell, field.components});
  options.histories = {{"time", "s", "end of the window", {}},
                       {"wheel/position", "m", "x of the contact at the middle of the window", {}},
                       {"wheel/contact_force", "N", "mean over the window, pressing", {}},
                       {"wheel/displacement", "m", "upwards, from touching the undeformed rail, end of the window", {}},
                       {"wheel/velocity", "m/s", "upwards, end of the window", {}}};
  if (track.patch() != nullptr)
    options.histories.insert(options.histories.end(), patch_histories.begin(), patch_histories.end());
  options.attributes = proto::provenance(program, file.name(), file.hash(), file.text());
  return options;
}

}  // namespace

FemRecord::FemRecord(const std::string& directory, const std::string& program, const proto::CaseFile& file,
                     const RailModel& rail, const WheelTrack& track, double window, std::int64_t interval_windows)
    : fields_(rail.fields()), window_s_(window), interval_windows_(interval_windows) {
  file_ = std::make_unique<proto::FieldSeriesFile>(
      proto::FieldSeriesFile::create(directory + "/fem.h5", file_options(program, file, rail, track, fields_)));
  if (track.patch() != nullptr)
    patch_ = std::make_unique<PatchRecord>(directory, program, file, *track.patch(), window, nullptr);
}

FemRecord::FemRecord(const std::string& directory, const std::string& program, const proto::CaseFile& file,
                     const RailModel& rail, const WheelTrack& track, double window, std::int64_t interval_windows,
                     proto::StateArchive& saved)
    : fields_(rail.fields()), window_s_(window), interval_windows_(interval_windows) {
  exchange(saved);
  file_ = std::make_unique<proto::FieldSeriesFile>(proto::FieldSeriesFile::resume(
      directory + "/fem.h5", n_steps_, n_history_rows_, file_options(program, file, rail, track, fields_)));
  if (track.patch() != nullptr)
    patch_ = std::make_unique<PatchRecord>(directory, program, file, *track.patch(), window, &saved);
}

void FemRecord::exchange(proto::StateArchive& archive) {
  archive("record/steps", n_steps_);
  archive("record/rows", n_history_rows_);
  if (patch_) patch_->exchange(archive);
}

void FemRecord::synchronise() {
  file_->synchronise();
  if (patch_) patch_->synchronise();
}

void FemRecord::put_patch(const WheelTrack& track) {
  const PatchContact& contact = *track.patch();
  const PatchState& patch = track.state().patch;
  const ShearResultant shear = resultant(contact.grid(), patch.traction);
  const auto zones = contact.zones(patch);
  const auto n_stick = static_cast<double>(std::count(zones.begin(), zones.end(), Zone::stick));
  const auto n_slip = static_cast<double>(std::count(zones.begin(), zones.end(), Zone::slip));
  file_->put_history("wheel/longitudinal_force", shear.longitudinal);
  file_->put_history("wheel/lateral_force", shear.lateral);
  file_->put_history("wheel/spin_moment", shear.moment);
  file_->put_history("wheel/longitudinal_creepage", contact.creepage(patch).longitudinal);
  file_->put_history("wheel/patch_area", (patch.pressure > 0).count() * contact.grid().area());
  file_->put_history("wheel/stick_share", n_stick > 0 ? n_stick / (n_stick + n_slip) : 0.0);
  patch_->window(track.state());
}

void FemRecord::put_fields(const WheelTrack& track) {
  const auto& state = track.state();
  file_->begin_step(static_cast<double>(state.windows) * window_s_);
  for (const auto& field : fields_)
    file_->put(field.name, field.values(state.track.displacement, state.track.velocity));
  file_->end_step();
  ++n_steps_;
}

void FemRecord::begin(const WheelTrack& track) {
  if (interval_windows_ > 0) put_fields(track);
}

void FemRecord::window(const WheelTrack& track) {
  const auto& state = track.state();
  file_->put_history("time", static_cast<double>(state.windows) * window_s_);
  file_->put_history("wheel/position", state.wheel_position);
  file_->put_history("wheel/contact_force", state.last.contact);
  file_->put_history("wheel/displacement", state.wheel.hub());
  file_->put_history("wheel/velocity", state.wheel.hub_velocity());
  if (patch_) put_patch(track);
  file_->end_history_row();
  ++n_history_rows_;
  if (interval_windows_ > 0 && state.windows % interval_windows_ == 0) put_fields(track);
}

void FemRecord::close() {
  file_->close();
  if (patch_) patch_->close();
}

namespace {

// The field has its size already.
void exchange(proto::StateArchive& archive, const std::string& name, PatchField& field) {
  std::vector<double> values(field.data(), field.data() + field.size());
  archive(name, values);
  archive.expect_length(name, values.size(), static_cast<std::size_t>(field.size()));
  std::copy(values.begin(), values.end(), field.data());
}

void exchange(proto::StateArchive& archive, PatchState& patch) {
  exchange(archive, "patch/pressure", patch.pressure);
  exchange(archive, "patch/shear_x", patch.traction.x);
  exchange(archive, "patch/shear_y", patch.traction.y);
  exchange(archive, "patch/slip_x", patch.slip.x);
  exchange(archive, "patch/slip_y", patch.slip.y);
  archive("patch/running_ahead", patch.running_ahead);
}

}  // namespace

void exchange(proto::StateArchive& archive, RunState& state) {
  archive("track/displacement", state.track.displacement);
  archive("track/velocity", state.track.velocity);
  archive("track/elastic", state.track.elastic);
  archive("wheel/displacement", state.wheel.displacement);
  archive("wheel/velocity", state.wheel.velocity);
  archive("wheel/position", state.wheel_position);
  archive("windows", state.windows);
  archive("interface/force", state.last.force);
  archive("interface/contact", state.last.contact);
  archive("interface/iterations", state.last.iterations);
  archive("wheel/windows_open", state.windows_open);
  if (state.patch.pressure.size() > 0) exchange(archive, state.patch);
}

std::int64_t windows_per_output(double output_interval, double window, const char* key) {
  const double ratio = output_interval / window;
  if (std::abs(ratio - std::round(ratio)) > 1e-6 || (output_interval > 0 && ratio < 0.5))
    throw proto::Error(proto::ExitCode::config, "the output interval is not a whole number of windows", key,
                       "give a multiple of coupling.window_s, or 0 for no field output");
  return std::llround(ratio);
}

}  // namespace fem
