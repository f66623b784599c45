#include "fem_solver/beam/beam_rail.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace fem {
namespace {

constexpr int per_node = 6, per_element = 12;
constexpr int shear_strain = 2, bending_strain = 5;  // rows of BeamElement::strain() in the vertical plane

SparseMatrix assemble(const BeamKinematics& beam, const BeamElement::Matrix12& of_element) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int e = 0; e < beam.n_elements(); ++e)
    for (int i = 0; i < per_element; ++i)
      for (int j = 0; j <= i; ++j)
        if (of_element(i, j) != 0.0) entries.emplace_back(per_node * e + i, per_node * e + j, of_element(i, j));
  SparseMatrix matrix(beam.n_dofs(), beam.n_dofs());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

RailMatrices matrices_of(const BeamKinematics& beam, const FemSettings& settings) {
  RailMatrices rail{assemble(beam, beam.element().stiffness()), assemble(beam, beam.element().mass()),
                    Eigen::VectorXd::Zero(beam.n_dofs()), Eigen::VectorXd()};
  const SectionProperties section = beam.section().properties();
  const Eigen::Vector3d impedance = end_impedance(settings, section);
  for (const int node : {0, beam.n_nodes() - 1})
    rail.end_damping.segment<3>(per_node * node) = section.area * impedance;
  const double density = settings.material.density * beam.planes().element_length;
  for (int n = 0; n < beam.n_nodes(); ++n) {
    const double damping = layer_damping(settings, beam.planes().x[n]) * density;
    const double vertical = section.inertia_vertical, lateral = section.inertia_lateral;
    rail.end_damping.segment<3>(per_node * n).array() += damping * section.area;
    rail.end_damping.segment<3>(per_node * n + 3) += damping * Eigen::Vector3d(vertical + lateral, vertical, lateral);
  }
  rail.weight = symmetric(rail.mass) * (-gravity * beam.rigid_motions(Eigen::Vector3d::Zero()).col(2));
  return rail;
}

BeamKinematics checked_beam(const FemSettings& settings, const std::vector<proto::RailSeat>& seats) {
  check_seats(settings, seats);
  return {settings.section(), settings.material, rail_planes(settings, settings.element_length),
          seats.front().origin[1]};
}

}  // namespace

BeamKinematics::BeamKinematics(const RailSection& section, const Material& material, const RailPlanes& planes,
                               double lateral)
    : section_(section),
      planes_(planes),
      lateral_(lateral),
      centroid_height_(section.properties().centroid_height),
      element_(section, material, planes.element_length) {}

std::vector<MotionWeight> BeamKinematics::motion_at(const Eigen::Vector3d& point) const {
  const double along = (point[0] - planes_.x.front()) / planes_.element_length;
  if (along < -1e-9 || along > n_elements() + 1e-9)
    throw proto::Error(proto::ExitCode::bad_data,
                       "the point x = " + std::to_string(point[0]) + " m lies beyond the rail", "[fem] n_bays",
                       "raise n_bays");
  section_.locate({point[1] - lateral_, point[2]});
  const int e = std::clamp(static_cast<int>(along), 0, n_elements() - 1);
  const BeamElement::Rows rows = element_.motion(along - e);
  const double y = point[1] - lateral_, z = point[2] - centroid_height_;
  // Displacement plus rotation x (0, y, z).
  Eigen::Matrix<double, 3, per_element> motion = rows.topRows<3>();
  motion.row(0) += z * rows.row(4) - y * rows.row(5);
  motion.row(1) -= z * rows.row(3);
  motion.row(2) += y * rows.row(3);
  std::vector<MotionWeight> result;
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < per_element; ++k)
      if (motion(c, k) != 0.0) result.push_back({c, per_node * e + k, motion(c, k)});
  return result;
}

Eigen::MatrixXd BeamKinematics::rigid_motions(const Eigen::Vector3d& centre) const {
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(n_dofs(), 6);
  for (int n = 0; n < n_nodes(); ++n)
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
      motions.block<3, 1>(per_node * n, i) = axis;
      motions.block<3, 1>(per_node * n, 3 + i) = axis.cross(node(n) - centre);
      motions.block<3, 1>(per_node * n + 3, 3 + i) = axis;
    }
  return motions;
}

BeamBand::BeamBand(const BeamKinematics& beam, int n_dofs)
    : RunningBand(
          [&] {
            std::vector<std::vector<Share>> stations;
            for (int n = 0; n < beam.n_nodes(); ++n)
              stations.push_back({{per_node * n + 2, 1.0}}), stations.push_back({{per_node * n + 4, 1.0}});
            return stations;
          }(),
          n_dofs),
      beam_(beam) {}

BandWeights BeamBand::at(double x) const {
  constexpr int margin = 3;  // elements
  const auto& planes = beam_.planes();
  const double along = (x - planes.x.front()) / planes.element_length;
  if (!(along >= planes.n_layer + margin && along <= beam_.n_elements() - planes.n_layer - margin)) refuse_end(x);
  const int e = static_cast<int>(along);
  const Eigen::RowVectorXd deflection = beam_.element().motion(along - e).row(2);
  return {2 * e,
          {deflection[2], deflection[4], deflection[8], deflection[10]},
          beam_.element().clamped_flexibility(along - e)};
}

BeamRail::BeamRail(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner)
    : beam_(checked_beam(settings, seats)),
      track_(assemble_track(settings, seats, owner, beam_, matrices_of(beam_, settings))),
      band_(beam_, track_.n_dofs()) {}

RailFigures BeamRail::figures() const {
  const auto& planes = beam_.planes();
  return {beam_.section().properties(), beam_.n_elements(), planes.element_length, planes.x.back() - planes.x.front()};
}

RailShape BeamRail::shape() const {
  RailShape shape;
  shape.nodes_per_cell = 2;
  for (int n = 0; n < beam_.n_nodes(); ++n) {
    const Eigen::Vector3d x = beam_.node(n);
    shape.points.insert(shape.points.end(), {x[0], x[1], x[2]});
  }
  for (int e = 0; e < beam_.n_elements(); ++e) shape.connectivity.insert(shape.connectivity.end(), {e, e + 1});
  return shape;
}

std::vector<double> BeamRail::at_nodes(const Eigen::VectorXd& field, int first) const {
  std::vector<double> values;
  for (int n = 0; n < beam_.n_nodes(); ++n)
    for (int c = 0; c < 3; ++c) values.push_back(field[per_node * n + first + c]);
  return values;
}

std::vector<double> BeamRail::section_forces(const Eigen::VectorXd& displacement, int strain) const {
  const BeamElement& element = beam_.element();
  const Eigen::RowVectorXd row = element.section_stiffness()[strain] * element.strain(0.5).row(strain);
  std::vector<double> values;
  for (int e = 0; e < beam_.n_elements(); ++e)
    values.push_back(row.dot(displacement.segment<per_element>(per_node * e)));
  return values;
}

std::vector<RailField> BeamRail::fields() const {
  using V = const Eigen::VectorXd&;
  return {{"displacement", "m", "of the rail's centroid from its unloaded, weightless state", true, 3,
           [this](V u, V) { return at_nodes(u, 0); }},
          {"velocity", "m/s", "of the rail's centroid", true, 3, [this](V, V v) { return at_nodes(v, 0); }},
          {"rotation", "rad", "of the cross-section", true, 3, [this](V u, V) { return at_nodes(u, 3); }},
          {"bending_moment", "N m", "vertical, at the middle of the element; positive where the foot is pulled", false,
           1, [this](V u, V) { return section_forces(u, bending_strain); }},
          {"shear_force", "N", "vertical, at the middle of the element", false, 1,
           [this](V u, V) { return section_forces(u, shear_strain); }}};
}

std::unique_ptr<RailModel> build_beam_rail(const FemSettings& settings, const std::vector<proto::RailSeat>& seats,
                                           SeatOwner owner) {
  return std::make_unique<BeamRail>(settings, seats, owner);
}

}  // namespace fem
