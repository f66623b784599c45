#include "fem_solver/assembly/rail_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace fem {

struct RailMesh::Data {
  RailSection section;
  std::vector<double> planes;
  double lateral;
  SolidMesh solid;

  int element(int slab, int quad) const { return slab * static_cast<int>(section.quads.size()) + quad; }
};

namespace {

HexahedronMesh extruded(const RailSection& section, const std::vector<double>& planes, double lateral) {
  const int n_vertices = static_cast<int>(section.vertices.size());
  HexahedronMesh mesh;
  for (const double x : planes)
    for (const auto& v : section.vertices) mesh.points.emplace_back(x, lateral + v[0], v[1]);
  for (int slab = 0; slab + 1 < static_cast<int>(planes.size()); ++slab)
    for (const auto& quad : section.quads) {
      std::array<int, 8> cell;
      for (int k = 0; k < 8; ++k) cell[k] = (slab + (k & 1)) * n_vertices + quad[k >> 1];
      mesh.cells.push_back(cell);
    }
  return mesh;
}

const std::vector<double>& ascending(const std::vector<double>& planes) {
  bool ascends = planes.size() >= 2;
  for (std::size_t i = 1; i < planes.size(); ++i) ascends = ascends && planes[i] > planes[i - 1];
  if (!ascends) throw proto::Error(proto::ExitCode::bad_data, "the planes of the rail mesh do not ascend", "[fem]");
  return planes;
}

}  // namespace

RailMesh::RailMesh(const RailSection& section, const std::vector<double>& planes, double lateral)
    : data_(new Data{section,
                     planes,
                     lateral,
                     {extruded(section, ascending(planes), lateral), Edges::straight, "[fem] profile"}}) {}

RailMesh::~RailMesh() = default;

int RailMesh::n_nodes() const {
  return data_->solid.n_nodes();
}
int RailMesh::n_elements() const {
  return data_->solid.n_elements();
}
const SolidMesh& RailMesh::solid() const {
  return data_->solid;
}
const RailSection& RailMesh::section() const {
  return data_->section;
}
const std::vector<double>& RailMesh::planes() const {
  return data_->planes;
}
double RailMesh::lateral() const {
  return data_->lateral;
}
const std::vector<Eigen::Vector3d>& RailMesh::nodes() const {
  return data_->solid.nodes();
}

Eigen::VectorXd RailMesh::end_face_areas() const {
  // The mesh is extruded: a node's volume in an end plane is its area times the Lobatto weight 1/6 of the slab's
  // length.
  const Eigen::VectorXd volumes = solid().node_volumes();
  const auto& x = data_->planes;
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(n_nodes());
  for (int n = 0; n < n_nodes(); ++n) {
    if (std::abs(nodes()[n][0] - x.front()) < 1e-9) areas[n] = 6 * volumes[n] / (x[1] - x[0]);
    if (std::abs(nodes()[n][0] - x.back()) < 1e-9) areas[n] = 6 * volumes[n] / (x.back() - x[x.size() - 2]);
  }
  return areas;
}

NodeWeights RailMesh::interpolation(const Eigen::Vector3d& point) const {
  const auto& x = data_->planes;
  if (point[0] < x.front() - 1e-9 || point[0] > x.back() + 1e-9)
    throw proto::Error(proto::ExitCode::bad_data,
                       "the point x = " + std::to_string(point[0]) + " m lies beyond the rail", "[fem] n_bays",
                       "raise n_bays");
  const auto above = std::upper_bound(x.begin(), x.end(), point[0]);
  const int slab = std::clamp(static_cast<int>(above - x.begin()) - 1, 0, static_cast<int>(x.size()) - 2);
  const auto place = data_->section.locate({point[1] - data_->lateral, point[2]});
  const Eigen::Vector3d local((point[0] - x[slab]) / (x[slab + 1] - x[slab]), place.local[0], place.local[1]);
  NodeWeights row;
  const auto& element = data_->solid.element_nodes(data_->element(slab, place.quad));
  for (int n = 0; n < SolidMesh::nodes_per_element; ++n) {
    const double weight = data_->solid.shape_value(n, local);
    if (std::abs(weight) > 1e-14) row.nodes.push_back(element[n]), row.weights.push_back(weight);
  }
  return row;
}

std::vector<MotionWeight> RailMesh::motion_at(const Eigen::Vector3d& point) const {
  const NodeWeights row = interpolation(point);
  std::vector<MotionWeight> motion;
  for (std::size_t k = 0; k < row.nodes.size(); ++k)
    for (int c = 0; c < 3; ++c) motion.push_back({c, 3 * row.nodes[k] + c, row.weights[k]});
  return motion;
}

Eigen::MatrixXd RailMesh::rigid_motions(const Eigen::Vector3d& centre) const {
  Eigen::MatrixXd motions(n_dofs(), 6);
  for (int n = 0; n < n_nodes(); ++n)
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
      motions.block<3, 1>(3 * n, i) = axis;
      motions.block<3, 1>(3 * n, 3 + i) = axis.cross(nodes()[n] - centre);
    }
  return motions;
}

NodeWeights RailMesh::section_mean(int plane) const {
  const Eigen::VectorXd volumes = solid().node_volumes();
  NodeWeights row;
  double sum = 0.0;
  for (int n = 0; n < n_nodes(); ++n)
    if (std::abs(nodes()[n][0] - data_->planes[plane]) < 1e-9)
      row.nodes.push_back(n), row.weights.push_back(volumes[n]), sum += volumes[n];
  for (double& w : row.weights) w /= sum;
  return row;
}

std::vector<std::array<int, 8>> RailMesh::hexahedra() const {
  // The first eight nodes of deal.II's Q2 element are its vertices, lexicographic; VTK goes around each face.
  std::vector<std::array<int, 8>> cells;
  for (int e = 0; e < n_elements(); ++e) {
    const auto& n = data_->solid.element_nodes(e);
    cells.push_back({n[0], n[1], n[3], n[2], n[4], n[5], n[7], n[6]});
  }
  return cells;
}

}  // namespace fem
