#include "fem_solver/assembly/rail_mesh.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/tria.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace fem {

struct RailMesh::Data {
  RailSection section;
  std::vector<double> planes;
  double lateral = 0.0;
  dealii::Triangulation<3> triangulation;
  dealii::FE_Q<3> fe{2};
  dealii::MappingQ1<3> mapping;
  dealii::DoFHandler<3> dofs;
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::vector<int>> element_nodes;  // [slab * n_quads + quad][27], order of deal.II

  int element(int slab, int quad) const { return slab * static_cast<int>(section.quads.size()) + quad; }
};

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
constexpr int per_element = 27;

Matrix6 elasticity(const Material& m) {
  const double lambda = m.young * m.poisson / ((1 + m.poisson) * (1 - 2 * m.poisson));
  const double mu = m.young / (2 * (1 + m.poisson));
  Matrix6 d = Matrix6::Zero();
  d.topLeftCorner<3, 3>().setConstant(lambda);
  for (int i = 0; i < 3; ++i) d(i, i) += 2 * mu, d(i + 3, i + 3) = mu;
  return d;
}

// Strain (xx, yy, zz, xy, yz, zx; shears doubled) of all 81 degrees of freedom of an element.
Eigen::Matrix<double, 6, Eigen::Dynamic> strain_operator(const dealii::FEValues<3>& values, unsigned point) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> b = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, 3 * per_element);
  for (int n = 0; n < per_element; ++n) {
    const auto g = values.shape_grad(n, point);
    b(0, 3 * n) = g[0], b(1, 3 * n + 1) = g[1], b(2, 3 * n + 2) = g[2];
    b(3, 3 * n) = g[1], b(3, 3 * n + 1) = g[0];
    b(4, 3 * n + 1) = g[2], b(4, 3 * n + 2) = g[1];
    b(5, 3 * n + 2) = g[0], b(5, 3 * n) = g[2];
  }
  return b;
}

void fill_triangulation(const RailSection& section, const std::vector<double>& planes, double lateral,
                        dealii::Triangulation<3>& triangulation) {
  const unsigned n_vertices = section.vertices.size();
  std::vector<dealii::Point<3>> points;
  for (const double x : planes)
    for (const auto& v : section.vertices) points.emplace_back(x, lateral + v[0], v[1]);
  std::vector<dealii::CellData<3>> cells;
  for (unsigned slab = 0; slab + 1 < planes.size(); ++slab)
    for (unsigned quad = 0; quad < section.quads.size(); ++quad) {
      dealii::CellData<3> cell(8);
      // deal.II counts x first, then y, then z.
      for (unsigned k = 0; k < 8; ++k) cell.vertices[k] = (slab + (k & 1)) * n_vertices + section.quads[quad][k >> 1];
      cell.material_id = quad;
      cells.push_back(cell);
    }
  triangulation.create_triangulation(points, cells, dealii::SubCellData());
}

}  // namespace

RailMesh::RailMesh(const RailSection& section, const std::vector<double>& planes, double lateral)
    : data_(std::make_unique<Data>()) {
  bool ascending = planes.size() >= 2;
  for (std::size_t i = 1; i < planes.size(); ++i) ascending = ascending && planes[i] > planes[i - 1];
  if (!ascending) throw proto::Error(proto::ExitCode::bad_data, "the planes of the rail mesh do not ascend", "[fem]");
  data_->section = section, data_->planes = planes, data_->lateral = lateral;
  try {
    fill_triangulation(section, planes, lateral, data_->triangulation);
  } catch (const dealii::ExceptionBase&) {
    throw proto::Error(proto::ExitCode::bad_data, "the rail mesh has inverted or distorted elements", "[fem] profile");
  }
  data_->dofs.reinit(data_->triangulation);
  data_->dofs.distribute_dofs(data_->fe);

  std::vector<dealii::Point<3>> support(data_->dofs.n_dofs());
  dealii::DoFTools::map_dofs_to_support_points(data_->mapping, data_->dofs, support);
  for (const auto& p : support) data_->nodes.emplace_back(p[0], p[1], p[2]);

  data_->element_nodes.resize(data_->triangulation.n_active_cells());
  std::vector<dealii::types::global_dof_index> indices(per_element);
  for (const auto& cell : data_->dofs.active_cell_iterators()) {
    const auto above = std::upper_bound(planes.begin(), planes.end(), cell->center()[0]);
    const int slab = static_cast<int>(above - planes.begin()) - 1;
    cell->get_dof_indices(indices);
    data_->element_nodes[data_->element(slab, cell->material_id())].assign(indices.begin(), indices.end());
  }
}

RailMesh::~RailMesh() = default;

int RailMesh::n_nodes() const {
  return static_cast<int>(data_->nodes.size());
}
int RailMesh::n_elements() const {
  return static_cast<int>(data_->element_nodes.size());
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
  return data_->nodes;
}

SparseMatrix RailMesh::stiffness(const Material& material) const {
  const Matrix6 d = elasticity(material);
  const dealii::QGauss<3> quadrature(3);
  dealii::FEValues<3> values(data_->mapping, data_->fe, quadrature,
                             dealii::update_gradients | dealii::update_JxW_values);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(n_elements()) * 81 * 41);
  for (const auto& cell : data_->dofs.active_cell_iterators()) {
    values.reinit(cell);
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(3 * per_element, 3 * per_element);
    for (unsigned q = 0; q < quadrature.size(); ++q) {
      const auto b = strain_operator(values, q);
      k.noalias() += b.transpose() * (d * values.JxW(q) * b).eval();
    }
    std::vector<dealii::types::global_dof_index> nodes(per_element);
    cell->get_dof_indices(nodes);
    for (int i = 0; i < 3 * per_element; ++i)
      for (int j = 0; j < 3 * per_element; ++j) {
        const int row = 3 * static_cast<int>(nodes[i / 3]) + i % 3, column = 3 * static_cast<int>(nodes[j / 3]) + j % 3;
        if (column <= row) entries.emplace_back(row, column, (k(i, j) + k(j, i)) / 2);
      }
  }
  SparseMatrix matrix(n_dofs(), n_dofs());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Eigen::VectorXd RailMesh::node_volumes() const {
  // Gauss-Lobatto points of Q2 are its nodes: the product rule lumps the mass without negative entries.
  const dealii::QGaussLobatto<3> quadrature(3);
  dealii::FEValues<3> values(data_->mapping, data_->fe, quadrature, dealii::update_values | dealii::update_JxW_values);
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(n_nodes());
  std::vector<dealii::types::global_dof_index> nodes(per_element);
  for (const auto& cell : data_->dofs.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(nodes);
    for (unsigned q = 0; q < quadrature.size(); ++q)
      for (int n = 0; n < per_element; ++n) volumes[nodes[n]] += values.shape_value(n, q) * values.JxW(q);
  }
  return volumes;
}

Eigen::VectorXd RailMesh::end_face_areas() const {
  // The mesh is extruded: a node's volume in an end plane is its area times the Lobatto weight 1/6 of the slab's
  // length.
  const Eigen::VectorXd volumes = node_volumes();
  const auto& x = data_->planes;
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(n_nodes());
  for (int n = 0; n < n_nodes(); ++n) {
    if (std::abs(data_->nodes[n][0] - x.front()) < 1e-9) areas[n] = 6 * volumes[n] / (x[1] - x[0]);
    if (std::abs(data_->nodes[n][0] - x.back()) < 1e-9) areas[n] = 6 * volumes[n] / (x.back() - x[x.size() - 2]);
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
  const dealii::Point<3> local((point[0] - x[slab]) / (x[slab + 1] - x[slab]), place.local[0], place.local[1]);
  NodeWeights row;
  const auto& nodes = data_->element_nodes[data_->element(slab, place.quad)];
  for (int n = 0; n < per_element; ++n) {
    const double weight = data_->fe.shape_value(n, local);
    if (std::abs(weight) > 1e-14) row.nodes.push_back(nodes[n]), row.weights.push_back(weight);
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
      motions.block<3, 1>(3 * n, 3 + i) = axis.cross(data_->nodes[n] - centre);
    }
  return motions;
}

NodeWeights RailMesh::section_mean(int plane) const {
  const Eigen::VectorXd volumes = node_volumes();
  NodeWeights row;
  double sum = 0.0;
  for (int n = 0; n < n_nodes(); ++n)
    if (std::abs(data_->nodes[n][0] - data_->planes[plane]) < 1e-9)
      row.nodes.push_back(n), row.weights.push_back(volumes[n]), sum += volumes[n];
  for (double& w : row.weights) w /= sum;
  return row;
}

std::vector<std::array<int, 8>> RailMesh::hexahedra() const {
  // The first eight nodes of deal.II's Q2 element are its vertices, lexicographic; VTK goes around each face.
  std::vector<std::array<int, 8>> cells;
  for (const auto& n : data_->element_nodes) cells.push_back({n[0], n[1], n[3], n[2], n[4], n[5], n[7], n[6]});
  return cells;
}

std::vector<double> RailMesh::von_mises(const Eigen::VectorXd& u, const Material& material) const {
  const Matrix6 d = elasticity(material);
  const dealii::QMidpoint<3> centre;
  dealii::FEValues<3> values(data_->mapping, data_->fe, centre, dealii::update_gradients);
  std::vector<double> result(n_elements());
  Eigen::VectorXd local(3 * per_element);
  for (const auto& cell : data_->dofs.active_cell_iterators()) {
    values.reinit(cell);
    const auto above = std::upper_bound(data_->planes.begin(), data_->planes.end(), cell->center()[0]);
    const int element = data_->element(static_cast<int>(above - data_->planes.begin()) - 1, cell->material_id());
    for (int n = 0; n < per_element; ++n) local.segment<3>(3 * n) = u.segment<3>(3 * data_->element_nodes[element][n]);
    const Eigen::Matrix<double, 6, 1> s = d * (strain_operator(values, 0) * local);
    const double normal = std::pow(s[0] - s[1], 2) + std::pow(s[1] - s[2], 2) + std::pow(s[2] - s[0], 2);
    result[element] = std::sqrt(normal / 2 + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
  }
  return result;
}

}  // namespace fem
