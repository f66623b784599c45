#include "fem_solver/output/fem_record.hpp"

#include <cmath>
#include <map>

#include "proto/result/provenance.hpp"

namespace fem {
namespace {

using proto::Location;

// Points are the corner nodes in ascending order; `corner_nodes` receives them.
proto::OutputMesh corner_mesh(const RailMesh& mesh, std::vector<int>& corner_nodes) {
  const auto hexahedra = mesh.hexahedra();
  std::map<int, std::int64_t> point_of;
  for (const auto& hexahedron : hexahedra)
    for (const int node : hexahedron) point_of[node] = 0;
  std::vector<double> points;
  for (auto& [node, point] : point_of) {
    point = static_cast<std::int64_t>(corner_nodes.size());
    corner_nodes.push_back(node);
    const auto& x = mesh.nodes()[node];
    points.insert(points.end(), {x[0], x[1], x[2]});
  }
  std::vector<std::int64_t> connectivity;
  for (const auto& hexahedron : hexahedra)
    for (const int node : hexahedron) connectivity.push_back(point_of[node]);
  return proto::OutputMesh::of_one_type(std::move(points), std::move(connectivity), proto::CellType::hexahedron);
}

std::vector<double> at_nodes(const std::vector<int>& nodes, const Eigen::VectorXd& field) {
  std::vector<double> values;
  values.reserve(3 * nodes.size());
  for (const int node : nodes) values.insert(values.end(), {field[3 * node], field[3 * node + 1], field[3 * node + 2]});
  return values;
}

}  // namespace

proto::FieldSeriesOptions FemRecord::options(const proto::CaseFile& file) {
  proto::FieldSeriesOptions options;
  options.mesh = corner_mesh(*system_.mesh, corner_nodes_);
  options.fields = {{"displacement", "m", "of the rail from its unloaded, weightless state", Location::point, 3},
                    {"velocity", "m/s", "of the rail", Location::point, 3},
                    {"von_mises_stress", "Pa", "von Mises stress at the centre of the element", Location::cell, 1}};
  options.histories = {{"time", "s", "end of the window", {}},
                       {"wheel/position", "m", "x of the contact at the middle of the window", {}},
                       {"wheel/contact_force", "N", "mean over the window, pressing", {}},
                       {"wheel/displacement", "m", "upwards, from touching the undeformed rail, end of the window", {}},
                       {"wheel/velocity", "m/s", "upwards, end of the window", {}}};
  options.attributes = proto::provenance("fem_solver", file.name(), file.hash(), file.text());
  return options;
}

FemRecord::FemRecord(const std::string& directory, const proto::CaseFile& file, const RailSystem& system,
                     const Material& material, double window, std::int64_t interval_windows)
    : system_(system), material_(material), window_s_(window), interval_windows_(interval_windows) {
  file_ =
      std::make_unique<proto::FieldSeriesFile>(proto::FieldSeriesFile::create(directory + "/fem.h5", options(file)));
}

FemRecord::FemRecord(const std::string& directory, const proto::CaseFile& file, const RailSystem& system,
                     const Material& material, double window, std::int64_t interval_windows, proto::StateArchive& saved)
    : system_(system), material_(material), window_s_(window), interval_windows_(interval_windows) {
  exchange(saved);
  file_ = std::make_unique<proto::FieldSeriesFile>(
      proto::FieldSeriesFile::resume(directory + "/fem.h5", n_steps_, n_history_rows_, options(file)));
}

void FemRecord::exchange(proto::StateArchive& archive) {
  archive("record/steps", n_steps_);
  archive("record/rows", n_history_rows_);
}

void FemRecord::fields(const WheelTrack& track) {
  const auto& state = track.state();
  file_->begin_step(static_cast<double>(state.windows) * window_s_);
  file_->put("displacement", at_nodes(corner_nodes_, state.track.displacement));
  file_->put("velocity", at_nodes(corner_nodes_, state.track.velocity));
  file_->put("von_mises_stress", system_.mesh->von_mises(state.track.displacement, material_));
  file_->end_step();
  ++n_steps_;
}

void FemRecord::begin(const WheelTrack& track) {
  if (interval_windows_ > 0) fields(track);
}

void FemRecord::window(const WheelTrack& track) {
  const auto& state = track.state();
  file_->put_history("time", static_cast<double>(state.windows) * window_s_);
  file_->put_history("wheel/position", state.wheel_position);
  file_->put_history("wheel/contact_force", state.last.contact);
  file_->put_history("wheel/displacement", state.wheel_displacement);
  file_->put_history("wheel/velocity", state.wheel_velocity);
  file_->end_history_row();
  ++n_history_rows_;
  if (interval_windows_ > 0 && state.windows % interval_windows_ == 0) fields(track);
}

void FemRecord::close() {
  file_->close();
}

void exchange(proto::StateArchive& archive, RunState& state) {
  archive("track/displacement", state.track.displacement);
  archive("track/velocity", state.track.velocity);
  archive("track/elastic", state.track.elastic);
  archive("wheel/displacement", state.wheel_displacement);
  archive("wheel/velocity", state.wheel_velocity);
  archive("wheel/position", state.wheel_position);
  archive("windows", state.windows);
  archive("interface/force", state.last.force);
  archive("interface/contact", state.last.contact);
  archive("interface/iterations", state.last.iterations);
}

std::int64_t windows_per_output(double output_interval, double window) {
  const double ratio = output_interval / window;
  if (std::abs(ratio - std::round(ratio)) > 1e-6 || (output_interval > 0 && ratio < 0.5))
    throw proto::Error(proto::ExitCode::config, "the output interval is not a whole number of windows",
                       "coupling.output_interval_s", "give a multiple of coupling.window_s, or 0 for no field output");
  return std::llround(ratio);
}

}  // namespace fem
