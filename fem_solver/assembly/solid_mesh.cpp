#include "fem_solver/assembly/solid_mesh.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/manifold_lib.h>
#include <deal.II/grid/tria.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>

#include "proto/error.hpp"

namespace fem {

struct SolidMesh::Data {
  explicit Data(Edges edges) : mapping(edges == Edges::straight ? 1 : 2) {}
  dealii::Triangulation<3> triangulation;  // a cell's material is its index in the mesh
  dealii::FE_Q<3> fe{2};
  dealii::MappingQ<3> mapping;
  dealii::DoFHandler<3> dofs;
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::vector<int>> element_nodes;  // [element][27], order of deal.II
};

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
constexpr int per_element = SolidMesh::nodes_per_element;

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

void fill_triangulation(const HexahedronMesh& mesh, Edges edges, dealii::Triangulation<3>& triangulation) {
  std::vector<dealii::Point<3>> points;
  for (const auto& p : mesh.points) points.emplace_back(p[0], p[1], p[2]);
  std::vector<dealii::CellData<3>> cells;
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    dealii::CellData<3> cell(8);
    for (unsigned k = 0; k < 8; ++k) cell.vertices[k] = mesh.cells[i][k];
    cell.material_id = static_cast<dealii::types::material_id>(i);
    cells.push_back(cell);
  }
  triangulation.create_triangulation(points, cells, dealii::SubCellData());
  if (edges == Edges::straight) return;
  triangulation.set_all_manifold_ids(0);
  triangulation.set_manifold(0, dealii::CylindricalManifold<3>(1));
}

}  // namespace

SolidMesh::SolidMesh(const HexahedronMesh& mesh, Edges edges, const char* where)
    : data_(std::make_unique<Data>(edges)) {
  try {
    fill_triangulation(mesh, edges, data_->triangulation);
  } catch (const dealii::ExceptionBase&) {
    throw proto::Error(proto::ExitCode::bad_data, "the mesh has inverted or distorted elements", where);
  }
  data_->dofs.reinit(data_->triangulation);
  data_->dofs.distribute_dofs(data_->fe);

  std::vector<dealii::Point<3>> support(data_->dofs.n_dofs());
  dealii::DoFTools::map_dofs_to_support_points(data_->mapping, data_->dofs, support);
  for (const auto& p : support) data_->nodes.emplace_back(p[0], p[1], p[2]);

  data_->element_nodes.resize(data_->triangulation.n_active_cells());
  std::vector<dealii::types::global_dof_index> indices(per_element);
  for (const auto& cell : data_->dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    data_->element_nodes[cell->material_id()].assign(indices.begin(), indices.end());
  }
}

SolidMesh::~SolidMesh() = default;

int SolidMesh::n_nodes() const {
  return static_cast<int>(data_->nodes.size());
}
int SolidMesh::n_elements() const {
  return static_cast<int>(data_->element_nodes.size());
}
const std::vector<Eigen::Vector3d>& SolidMesh::nodes() const {
  return data_->nodes;
}
const std::vector<int>& SolidMesh::element_nodes(int element) const {
  return data_->element_nodes[element];
}

SparseMatrix SolidMesh::stiffness(const Material& material) const {
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

Eigen::VectorXd SolidMesh::node_volumes() const {
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

double SolidMesh::shape_value(int node, const Eigen::Vector3d& local) const {
  return data_->fe.shape_value(node, dealii::Point<3>(local[0], local[1], local[2]));
}

std::vector<double> SolidMesh::von_mises(const Eigen::VectorXd& u, const Material& material) const {
  const Matrix6 d = elasticity(material);
  const dealii::QMidpoint<3> centre;
  dealii::FEValues<3> values(data_->mapping, data_->fe, centre, dealii::update_gradients);
  std::vector<double> result(n_elements());
  Eigen::VectorXd local(3 * per_element);
  for (const auto& cell : data_->dofs.active_cell_iterators()) {
    values.reinit(cell);
    const int element = static_cast<int>(cell->material_id());
    for (int n = 0; n < per_element; ++n) local.segment<3>(3 * n) = u.segment<3>(3 * data_->element_nodes[element][n]);
    const Eigen::Matrix<double, 6, 1> s = d * (strain_operator(values, 0) * local);
    const double normal = std::pow(s[0] - s[1], 2) + std::pow(s[1] - s[2], 2) + std::pow(s[2] - s[0], 2);
    result[element] = std::sqrt(normal / 2 + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
  }
  return result;
}

}  // namespace fem
