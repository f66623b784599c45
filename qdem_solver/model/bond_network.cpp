#include "qdem_solver/model/bond_network.hpp"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <map>
#include <stdexcept>

#include "proto/error.hpp"

namespace qdem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;

constexpr double pull_tolerance = 1e-9;  ///< of the residual force

Vector3d bond_vector(const Template& shape, const std::array<int, 2>& nodes) {
  return shape.nodes[nodes[1]] - shape.nodes[nodes[0]];
}

BondNetwork uncalibrated(const Template& shape) {
  std::map<std::array<int, 2>, double> stiffness;
  for (int e = 0; e < shape.n_tets(); ++e) {
    const double share = bond_share(shape, e);
    for (const auto& edge : tet_edges) {
      const int p = shape.tets[e][edge[0]], q = shape.tets[e][edge[1]];
      stiffness[{std::min(p, q), std::max(p, q)}] += share;
    }
  }
  BondNetwork bonds;
  for (const auto& [nodes, value] : stiffness) {
    bonds.nodes.push_back(nodes), bonds.stiffness.push_back(value);
    bonds.lengths.push_back(bond_vector(shape, nodes).norm());
  }
  bonds.adjacency = make_adjacency(shape.n_nodes(), bonds.nodes);
  return bonds;
}

int longest_side(const Template& shape) {
  Vector3d low = shape.nodes[0], high = low;
  for (const Vector3d& x : shape.nodes) low = low.cwiseMin(x), high = high.cwiseMax(x);
  int axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

/// Nodal forces of a uniform unit tension along an axis on the surface.
VectorXd unit_tension(const Template& shape, int axis) {
  VectorXd force = VectorXd::Zero(3 * shape.n_nodes());
  for (const Triangle& triangle : shape.triangles) {
    const auto& n = triangle.nodes;
    const Vector3d& first = shape.nodes[n[0]];
    const Vector3d area = 0.5 * (shape.nodes[n[1]] - first).cross(shape.nodes[n[2]] - first);
    for (const int node : n) force[3 * node + axis] += area[axis] / 3;
  }
  return force;
}

/// E of the pulled specimen over the E of its bonds: the forces f of a unit tension do the work f u = V / E.
double pulled_young(const Template& shape, const BondNetwork& bonds) {
  const VectorXd force = unit_tension(shape, longest_side(shape));
  const Matrix stiffness = bond_stiffness(shape, bonds);
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver(stiffness);
  solver.setTolerance(pull_tolerance);
  const VectorXd displacement = solver.solve(force);
  const double work = force.dot(displacement);
  if (solver.info() != Eigen::Success || !(work > 0)) {
    throw proto::Error(proto::ExitCode::numerics, "the bonds of a specimen that is pulled find no balance",
                       "template " + shape.name, "mesh it again: parts that hang on one edge or node are loose");
  }
  return shape.volume() / work;
}

}  // namespace

double bond_share(const Template& shape, int tet) {
  const auto& nodes = shape.tets[tet];
  double squares = 0.0;
  for (const auto& edge : tet_edges) squares += bond_vector(shape, {nodes[edge[0]], nodes[edge[1]]}).squaredNorm();
  return 6 * shape.volumes[tet] / squares;
}

BondNetwork make_bond_network(const Template& shape) {
  BondNetwork bonds = uncalibrated(shape);
  bonds.calibration = 1 / pulled_young(shape, bonds);
  for (double& stiffness : bonds.stiffness) stiffness *= bonds.calibration;
  return bonds;
}

const BondNetwork& bonds_of(const Template& shape) {
  if (!shape.bonds) throw std::logic_error("template " + shape.name + " has no bonds: call make_batches()");
  return *shape.bonds;
}

Matrix bond_stiffness(const Template& shape, const BondNetwork& bonds) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(36 * bonds.nodes.size());
  for (std::size_t b = 0; b < bonds.nodes.size(); ++b) {
    const Vector3d n = bond_vector(shape, bonds.nodes[b]) / bonds.lengths[b];
    const Eigen::Matrix3d block = bonds.stiffness[b] * n * n.transpose();
    for (int corners = 0; corners < 4; ++corners) {
      const int p = corners / 2, q = corners % 2;
      for (int i = 0; i < 9; ++i) {
        entries.emplace_back(3 * bonds.nodes[b][p] + i / 3, 3 * bonds.nodes[b][q] + i % 3,
                             p == q ? block(i / 3, i % 3) : -block(i / 3, i % 3));
      }
    }
  }
  Matrix result(3 * shape.n_nodes(), 3 * shape.n_nodes());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace qdem
