#include "fem_solver/assembly/rail_system.hpp"

namespace fem {
namespace {

RailMatrices matrices_of(const RailMesh& mesh, const FemSettings& s) {
  const int n = mesh.n_dofs();
  const Eigen::VectorXd volumes = mesh.node_volumes(), areas = mesh.end_face_areas();
  const Eigen::Vector3d impedance = end_impedance(s, mesh.section().properties());
  RailMatrices rail{mesh.stiffness(s.material), SparseMatrix(n, n), Eigen::VectorXd(n), Eigen::VectorXd::Zero(n)};
  rail.mass.setIdentity();
  for (int i = 0; i < n; ++i) {
    rail.mass.coeffRef(i, i) = s.material.density * volumes[i / 3];
    rail.end_damping[i] = impedance[i % 3] * areas[i / 3];
    if (i % 3 == 2) rail.weight[i] = -gravity * rail.mass.coeff(i, i);
  }
  return rail;
}

}  // namespace

RailSystem build_rail_system(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner) {
  check_seats(settings, seats);
  const RailPlanes planes = rail_planes(settings);
  auto mesh = std::make_unique<RailMesh>(rail_section(settings.profile), planes.x, seats.front().origin[1]);
  RailSystem system;
  static_cast<TrackSystem&>(system) = assemble_track(settings, seats, owner, *mesh, matrices_of(*mesh, settings));
  system.mesh = std::move(mesh);
  system.element_length = planes.element_length;
  system.planes_per_bay = planes.per_bay;
  return system;
}

}  // namespace fem
