// A sleeper block on a few cubes on the ground: a bed for tests that is there at once, with its case file.
#pragma once

#include <unistd.h>

#include <fstream>
#include <string>

#include "proto/case/case_file.hpp"
#include "qdem_solver/bed/bed.hpp"
#include "tests/support/box_mesh.hpp"

namespace tests {

/// Sleeper 0.3 x 0.4 x 0.1 m with its top at z = 0 on twelve cubes that stand on a plane; soft, so that steps are long.
inline qdem::Bed small_bed(const proto::CaseFile&, const qdem::BedPhysics& physics) {
  qdem::Bed bed;
  qdem::Model& model = bed.model;
  model.materials = {physics.stone, physics.sleeper};
  model.templates = {box_template({6, 8, 2}, {0.3, 0.4, 0.1}), box_template({2, 2, 2}, {0.06, 0.06, 0.06})};
  model.gravity = physics.gravity, model.contact = physics.contact, model.pad_body = 0;
  const double gap = 2 * physics.contact.rounding;
  qdem::Body sleeper;
  sleeper.kind = qdem::BodyKind::sleeper, sleeper.name = "sleeper", sleeper.material_id = 1;
  model.bodies.push_back(sleeper);
  std::vector<qdem::Placement> places(1);
  places[0].translation = {-0.15, 0.55, -0.1};
  for (int i = 0; i < 12; ++i) {
    qdem::Body stone;
    stone.name = "stone " + std::to_string(i), stone.template_id = 1;
    model.bodies.push_back(stone);
    qdem::Placement place;
    place.translation = Eigen::Vector3d(-0.14 + 0.1 * (i % 3), 0.56 + 0.1 * (i / 3), -0.16 - gap);
    places.push_back(place);
  }
  model.planes.push_back({"ground", {0, 0, -0.16 - 1.5 * gap}, {0, 0, 1}, {0, 0, 0}, physics.ground_friction});
  qdem::make_batches(model);
  bed.state = qdem::make_state(model, places);
  bed.report.stones = 12, bed.report.elements = 12 * 48 + 6 * 8 * 2 * 6, bed.report.porosity_layer = 0.4;
  bed.report.hash = "0123456789abcdef";
  return bed;
}

/// The case of small_bed(); `qdem` and `coupling` are appended to their sections. Returns the file's path.
inline std::string small_bed_case(const std::string& folder, const std::string& qdem = "",
                                  const std::string& coupling = "") {
  const std::string path = folder + "/small_bed_" + std::to_string(getpid()) + ".toml";
  std::ofstream out(path);
  out << "[coupling]\nwindow_s = 1e-4\nduration_s = 0.01\n"
      << coupling << R"(
[track]
gauge_m = 1.435
sleeper_spacing_m = 0.6
[[rail_seat]]
name = "seat"
origin_m = [0.0, 0.75, 0.0]
longitudinal_axis = [1, 0, 0]
lateral_axis = [0, 1, 0]
half_lengths_m = [0.075, 0.07]
cells = [2, 2]
stiffness_n_per_m = [6e6, 5e6, 2e7]
damping_ns_per_m = [2e3, 2e3, 4e3]
clip_preload_n = 0.0
tension_cutoff = false
[qdem]
)" << qdem
      << R"(
[[qdem.material]]
name = "stone"
young_pa = 1e9
poisson = 0.25
density_kg_per_m3 = 2700
retardation_time_s = 1e-6
[[qdem.material]]
name = "sleeper"
young_pa = 1e9
poisson = 0.2
density_kg_per_m3 = 2400
lame_viscosity_pa_s = 300
shear_viscosity_pa_s = 400
[qdem.contact]
normal_stiffness_n_per_m = 1e6
damping_ratio = 0.05
friction = 0.6
rounding_m = 1e-3
)";
  return path;
}

}  // namespace tests
