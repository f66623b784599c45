#include "fem_solver/assembly/rail_system.hpp"

namespace fem {
namespace {

RailMatrices matrices_of(const RailMesh& mesh, const FemSettings& s) {
  const int n = mesh.n_dofs();
  const Eigen::VectorXd volumes = mesh.solid().node_volumes(), areas = mesh.end_face_areas();
  const Eigen::Vector3d impedance = end_impedance(s, mesh.section().properties());
  RailMatrices rail{mesh.solid().stiffness(s.material), SparseMatrix(n, n), Eigen::VectorXd(n),
                    Eigen::VectorXd::Zero(n)};
  rail.mass.setIdentity();
  for (int i = 0; i < n; ++i) {
    rail.mass.coeffRef(i, i) = s.material.density * volumes[i / 3];
    rail.end_damping[i] =
        impedance[i % 3] * areas[i / 3] + layer_damping(s, mesh.nodes()[i / 3][0]) * rail.mass.coeff(i, i);
    if (i % 3 == 2) rail.weight[i] = -gravity * rail.mass.coeff(i, i);
  }
  return rail;
}

}  // namespace

RailSystem build_rail_system(const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner) {
  check_seats(settings, seats);
  const RailPlanes planes = rail_planes(settings, settings.end_layer_element_length);
  auto mesh = std::make_unique<RailMesh>(settings.section(), planes.x, seats.front().origin[1]);
  RailSystem system;
  static_cast<TrackSystem&>(system) = assemble_track(settings, seats, owner, *mesh, matrices_of(*mesh, settings));
  system.mesh = std::move(mesh);
  system.element_length = planes.element_length;
  system.planes_per_bay = planes.per_bay;
  system.fine_begin = planes.fine_begin(), system.fine_end = planes.fine_end();
  return system;
}

}  // namespace fem
