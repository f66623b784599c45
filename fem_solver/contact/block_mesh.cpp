#include "fem_solver/contact/block_mesh.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace fem {
namespace {

using Point = dealii::Point<3>;
constexpr double pi = 3.14159265358979323846;
constexpr double smallest_width = 20.0;  // of the block, in semi-axes

// Displacement at a place of the half-space z <= 0 under a unit force at the origin, down or along x.
Eigen::Vector3d half_space_motion(const Point& p, const ElasticBody& body, BlockLoad load) {
  const double shear = body.young / (2 * (1 + body.poisson)), q = 1 - 2 * body.poisson;
  const double x = p[0], y = p[1], depth = -p[2], r = p.norm(), scale = 1 / (4 * pi * shear);
  const double r3 = r * r * r, s = r + depth;
  if (load == BlockLoad::pressing) {
    const double out = depth / r3 - q / (r * s);
    return scale * Eigen::Vector3d(x * out, y * out, -(depth * depth / r3 + 2 * (1 - body.poisson) / r));
  }
  const double along = 1 / r + x * x / r3 + q * (1 / s - x * x / (r * s * s));
  const double across = x * y / r3 - q * x * y / (r * s * s), down = x * depth / r3 + q * x / (r * s);
  return scale * Eigen::Vector3d(along, across, -down);
}

// Cells get half as large again and again around the origin, four of a size before the next: with two the approach is
// 1.6 % short, however fine the surface. The last ones cover `reach` of the surface and half a
// semi-axis of depth.
void refine(dealii::Triangulation<3>& block, double width, int levels, double reach) {
  double side = width;
  for (int level = 0; level < levels; ++level, side /= 2) {
    const double wide = std::max(reach, 4 * side) - 1e-9, deep = std::max(0.5, 4 * side) - 1e-9;
    for (const auto& cell : block.active_cell_iterators()) {
      if (cell->level() != level) continue;
      const Point c = cell->center();
      if (std::max(c[0], c[1]) - side / 2 < wide && -c[2] - side / 2 < deep) cell->set_refine_flag();
    }
    block.execute_coarsening_and_refinement();
  }
}

struct Block {
  dealii::Triangulation<3> triangulation;
  dealii::FESystem<3> fe{dealii::FE_Q<3>(1), 3};
  dealii::MappingQ1<3> mapping;
  dealii::DoFHandler<3> dofs;
  double width = 0.0;               // in semi-axes
  std::vector<Point> places;        // per degree of freedom [m]
  std::vector<unsigned> component;  // per degree of freedom
};

void build_mesh(Block& block, const BlockShape& shape, double reach) {
  const int levels = static_cast<int>(std::ceil(std::log2(smallest_width * shape.elements)));
  block.width = std::pow(2.0, levels) / shape.elements;
  dealii::GridGenerator::hyper_rectangle(block.triangulation, Point(0, 0, -block.width),
                                         Point(block.width, block.width, 0));
  refine(block.triangulation, block.width, levels, reach);
  const double depth = std::sqrt(shape.semi_axis_x * shape.semi_axis_y);
  dealii::GridTools::transform(
      [&](const Point& p) { return Point(p[0] * shape.semi_axis_x, p[1] * shape.semi_axis_y, p[2] * depth); },
      block.triangulation);
  block.dofs.reinit(block.triangulation);
  block.dofs.distribute_dofs(block.fe);
  block.places.resize(block.dofs.n_dofs());
  dealii::DoFTools::map_dofs_to_support_points(block.mapping, block.dofs, block.places);
  block.component.resize(block.dofs.n_dofs());
  std::vector<dealii::types::global_dof_index> indices(block.fe.n_dofs_per_cell());
  for (const auto& cell : block.dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    for (unsigned k = 0; k < indices.size(); ++k)
      block.component[indices[k]] = block.fe.system_to_component_index(k).first;
  }
}

dealii::AffineConstraints<double> constraints_of(const Block& block, const BlockShape& shape, const ElasticBody& body,
                                                 BlockLoad load, std::vector<char>& is_fixed) {
  dealii::AffineConstraints<double> constraints;
  dealii::DoFTools::make_hanging_node_constraints(block.dofs, constraints);
  const double small = 1e-6, x_end = block.width * shape.semi_axis_x, y_end = block.width * shape.semi_axis_y;
  const double bottom = -block.width * std::sqrt(shape.semi_axis_x * shape.semi_axis_y);
  is_fixed.assign(block.places.size(), 0);
  for (std::size_t dof = 0; dof < block.places.size(); ++dof) {
    const Point& p = block.places[dof];
    const unsigned c = block.component[dof];
    const bool far = p[0] > (1 - small) * x_end || p[1] > (1 - small) * y_end || p[2] < (1 - small) * bottom;
    const bool at_x = p[0] < small * shape.semi_axis_x, at_y = p[1] < small * shape.semi_axis_y;
    const bool held_x = at_x && (load == BlockLoad::pressing ? c == 0 : c != 0), held_y = at_y && c == 1;
    if (!far && !held_x && !held_y) continue;
    is_fixed[dof] = 1;
    if (constraints.is_constrained(dof)) continue;  // a hanging node between nodes that are held themselves
    constraints.add_line(dof);
    if (far && !held_x && !held_y) constraints.set_inhomogeneity(dof, half_space_motion(p, body, load)[c]);
  }
  constraints.close();
  return constraints;
}

void assemble(const Block& block, const ElasticBody& body, const dealii::AffineConstraints<double>& constraints,
              dealii::SparseMatrix<double>& matrix, dealii::Vector<double>& right) {
  const double mu = body.young / (2 * (1 + body.poisson));
  const double lambda = body.young * body.poisson / ((1 + body.poisson) * (1 - 2 * body.poisson));
  const dealii::QGauss<3> rule(2);
  dealii::FEValues<3> values(block.mapping, block.fe, rule, dealii::update_gradients | dealii::update_JxW_values);
  const unsigned n = block.fe.n_dofs_per_cell();
  dealii::FullMatrix<double> local(n, n);
  const dealii::Vector<double> nothing(n);
  std::vector<dealii::types::global_dof_index> indices(n);
  for (const auto& cell : block.dofs.active_cell_iterators()) {
    values.reinit(cell);
    local = 0.0;
    for (unsigned point = 0; point < rule.size(); ++point)
      for (unsigned i = 0; i < n; ++i)
        for (unsigned j = 0; j < n; ++j) {
          const unsigned ci = block.fe.system_to_component_index(i).first,
                         cj = block.fe.system_to_component_index(j).first;
          const auto gi = values.shape_grad(i, point), gj = values.shape_grad(j, point);
          const double same = ci == cj ? mu * (gi * gj) : 0.0;
          local(i, j) += (lambda * gi[ci] * gj[cj] + mu * gi[cj] * gj[ci] + same) * values.JxW(point);
        }
    cell->get_dof_indices(indices);
    constraints.distribute_local_to_global(local, nothing, indices, matrix, right, false);
  }
}

SparseMatrix lower_triangle(const dealii::SparseMatrix<double>& matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  for (unsigned row = 0; row < matrix.m(); ++row)
    for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
      if (entry->column() <= row && entry->value() != 0.0)
        entries.emplace_back(static_cast<int>(row), static_cast<int>(entry->column()), entry->value());
  SparseMatrix lower(static_cast<int>(matrix.m()), static_cast<int>(matrix.m()));
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

}  // namespace

BlockSystem build_block(const BlockShape& shape, const ElasticBody& body, BlockLoad load) {
  if (!(shape.semi_axis_x > 0 && shape.semi_axis_y > 0) || shape.elements < 2 || shape.elements % 2 != 0)
    throw proto::Error(proto::ExitCode::bad_data,
                       "a block needs a patch and an even number of elements to its semi-axes", "contact.grid");
  BlockSystem system;
  // The finest surface ends at a boundary of the cells before the last halving; there every other node hangs.
  const int half = static_cast<int>(std::ceil(shape.margin * shape.elements / 2 - 1e-9));
  system.n_side = 2 * half;
  system.dx = shape.semi_axis_x / shape.elements, system.dy = shape.semi_axis_y / shape.elements;
  Block block;
  build_mesh(block, shape, 2.0 * half / shape.elements);
  system.n_cells = static_cast<int>(block.triangulation.n_active_cells());
  const auto constraints = constraints_of(block, shape, body, load, system.is_fixed);

  dealii::DynamicSparsityPattern pattern(block.dofs.n_dofs());
  dealii::DoFTools::make_sparsity_pattern(block.dofs, pattern, constraints, false);
  dealii::SparsityPattern sparsity;
  sparsity.copy_from(pattern);
  dealii::SparseMatrix<double> matrix(sparsity);
  dealii::Vector<double> right(block.dofs.n_dofs());
  assemble(block, body, constraints, matrix, right);
  system.stiffness = lower_triangle(matrix);
  system.far_load = Eigen::Map<const Eigen::VectorXd>(right.begin(), static_cast<Eigen::Index>(right.size()));

  system.surface.assign(static_cast<std::size_t>(system.n_side * system.n_side), {-1, -1, -1});
  for (std::size_t dof = 0; dof < block.places.size(); ++dof) {
    const Point& p = block.places[dof];
    if (p[2] < -1e-6 * system.dx) continue;
    const int i = static_cast<int>(std::lround(p[0] / system.dx)), j = static_cast<int>(std::lround(p[1] / system.dy));
    if (i < system.n_side && j < system.n_side)
      system.surface[static_cast<std::size_t>(i + system.n_side * j)][block.component[dof]] = static_cast<int>(dof);
  }
  return system;
}

}  // namespace fem
