#include "fem_solver/wheel/solid_wheel.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "fem_solver/linear/cholesky.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double contact_angle = 2.5 * pi / 180, coarsest_angle = 15 * pi / 180;
constexpr int n_pairs = 12;

// Free degrees of freedom of a mesh whose bore is held: -1 where held.
std::vector<int> free_numbers(const SolidMesh& mesh, double bore_radius, int& n_free) {
  std::vector<int> numbers(mesh.n_dofs(), -1);
  n_free = 0;
  for (int n = 0; n < mesh.n_nodes(); ++n) {
    const auto& x = mesh.nodes()[n];
    if (std::hypot(x[0], x[2]) < bore_radius + 1e-6) continue;
    for (int c = 0; c < 3; ++c) numbers[3 * n + c] = n_free++;
  }
  return numbers;
}

SparseMatrix free_part(const SparseMatrix& lower, const std::vector<int>& numbers, int n_free) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(lower.nonZeros());
  for (int column = 0; column < lower.outerSize(); ++column)
    for (SparseMatrix::InnerIterator it(lower, column); it; ++it)
      if (numbers[it.row()] >= 0 && numbers[column] >= 0)
        entries.emplace_back(numbers[it.row()], numbers[column], it.value());
  SparseMatrix part(n_free, n_free);
  part.setFromTriplets(entries.begin(), entries.end());
  return part;
}

// The tread side of the block that carries the contact.
struct ContactSide {
  Eigen::Vector2d first, second;  // (y, r) [m]
  ContactSide(const Meridian& m)
      : first(m.vertices[m.quads[m.contact_quad][0]]), second(m.vertices[m.quads[m.contact_quad][1]]) {}
  double width() const { return second[0] - first[0]; }
  double radius() const { return (first[1] + second[1]) / 2; }
};

// Vertical unit force, spread evenly over a patch: Simpson's weights of the elements' quadratic edges, which are
// `angle` wide, two along the tread and one across.
Eigen::VectorXd patch_load(const SolidMesh& mesh, const std::vector<int>& numbers, int n_free, const ContactSide& side,
                           double angle) {
  constexpr double along[5] = {1.0 / 12, 4.0 / 12, 2.0 / 12, 4.0 / 12, 1.0 / 12},
                   across[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
  Eigen::VectorXd load = Eigen::VectorXd::Zero(n_free);
  for (int n = 0; n < mesh.n_nodes(); ++n) {
    const auto& x = mesh.nodes()[n];
    const double i = 2 + std::atan2(x[0], -x[2]) / (angle / 2), share = (x[1] - side.first[0]) / side.width();
    const double tread = side.first[1] + share * (side.second[1] - side.first[1]);
    if (std::abs(std::hypot(x[0], x[2]) - tread) < 1e-5 && i > -0.1 && i < 4.1 && share > -0.1 && share < 1.1)
      load[numbers[3 * n + 2]] += along[std::lround(i)] * across[std::lround(2 * share)];
  }
  return load;
}

// Mean displacement of a rectangle under unit force, spread evenly on a half-space: Boussinesq's 1/r integrated twice
// over sides a and b.
double half_space_flexibility(const Material& material, double a, double b) {
  const double d = std::hypot(a, b);
  const double integral = 2 * a * a * b * std::log((b + d) / a) + 2 * a * b * b * std::log((a + d) / b) +
                          2.0 / 3 * (a * a * a + b * b * b - d * d * d);
  return (1 - material.poisson * material.poisson) / (pi * material.young) * integral / (a * a * b * b);
}

// Orthonormal in the masses against the first `n` columns of `basis`; the last one is made so. False when nothing is
// left of it.
bool orthonormalise(Eigen::MatrixXd& basis, int n, const Eigen::VectorXd& mass) {
  auto v = basis.col(n);
  const double size = std::sqrt(v.dot(mass.cwiseProduct(v)));
  for (int pass = 0; pass < 2; ++pass)
    v -= basis.leftCols(n) * (basis.leftCols(n).transpose() * mass.cwiseProduct(v)).eval();
  const double left = std::sqrt(v.dot(mass.cwiseProduct(v)));
  v /= left;
  return left > 1e-9 * size;
}

// Rounding brings in low modes that neither force excites (bending of a symmetric web): they are left out.
ReducedWheel excited_modes(ReducedWheel all) {
  constexpr double least = 1e-6;
  const double shaken = least * all.participation.cwiseAbs().maxCoeff(),
               pressed = least * all.contact.cwiseAbs().maxCoeff();
  int n = 0;
  for (Eigen::Index i = 0; i < all.contact.size(); ++i) {
    if (std::abs(all.participation[i]) < shaken && std::abs(all.contact[i]) < pressed) continue;
    for (auto* row : {&all.circular_squared, &all.participation, &all.contact}) (*row)[n] = (*row)[i];
    ++n;
  }
  for (auto* row : {&all.circular_squared, &all.participation, &all.contact}) row->conservativeResize(n);
  return all;
}

}  // namespace

ReducedWheel reduce_wheel(const Meridian& meridian, const Material& material, double finest_angle, int n_blocks) {
  const SolidMesh mesh(revolved(meridian, wheel_angles(finest_angle, coarsest_angle)), Edges::revolved_about_y,
                       "[wheel.solid]");
  int n_free = 0;
  const auto numbers = free_numbers(mesh, meridian.bore_radius, n_free);
  const SparseMatrix stiffness = free_part(mesh.stiffness(material), numbers, n_free);
  const Eigen::VectorXd volumes = mesh.node_volumes();
  Eigen::VectorXd mass(n_free), shake = Eigen::VectorXd::Zero(n_free);
  for (int dof = 0; dof < mesh.n_dofs(); ++dof) {
    if (numbers[dof] < 0) continue;
    mass[numbers[dof]] = material.density * volumes[dof / 3];
    if (dof % 3 == 2) shake[numbers[dof]] = mass[numbers[dof]];
  }
  const ContactSide side(meridian);
  const Eigen::VectorXd contact = patch_load(mesh, numbers, n_free, side, finest_angle);

  const Cholesky factor(stiffness, "wheel");
  Eigen::MatrixXd basis(n_free, 2 * n_blocks);
  int n = 0;
  for (int k = 0; k < 2 * n_blocks; ++k) {
    const Eigen::VectorXd force = k == 0 ? contact : k == 1 ? shake : mass.cwiseProduct(basis.col(n - 2)).eval();
    basis.col(n) = factor.solve(force);
    if (!orthonormalise(basis, n, mass)) break;
    ++n;
  }
  basis.conservativeResize(Eigen::NoChange, n);
  const Eigen::MatrixXd projected = basis.transpose() * (symmetric(stiffness) * basis).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes((projected + projected.transpose()) / 2);
  return excited_modes({material.density * volumes.sum(), modes.eigenvalues(),
                        modes.eigenvectors().transpose() * (basis.transpose() * shake).eval(),
                        modes.eigenvectors().transpose() * (basis.transpose() * contact).eval(),
                        half_space_flexibility(material, 2 * finest_angle * side.radius(), side.width())});
}

WheelModel solid_wheel(const WheelSettings& settings) {
  const Material material{settings.wheel.young, settings.wheel.poisson, settings.solid.density};
  const Meridian meridian = wheel_meridian(settings.solid, settings.radius);
  const double mass = material.density * meridian.volume();
  if (mass > settings.unsprung_mass)
    throw proto::Error(proto::ExitCode::bad_data,
                       "the solid wheel weighs " + std::to_string(mass) + " kg, more than the unsprung mass",
                       "[wheel] unsprung_mass_kg, [wheel.solid]", "raise the mass or give a lighter web");
  const ReducedWheel reduced = reduce_wheel(meridian, material, contact_angle, n_pairs);
  const int n = static_cast<int>(reduced.circular_squared.size()) + 1;
  WheelModel wheel;
  wheel.mass = Eigen::MatrixXd::Identity(n, n);
  wheel.mass(0, 0) = settings.unsprung_mass;
  wheel.mass.block(1, 0, n - 1, 1) = reduced.participation;
  wheel.mass.block(0, 1, 1, n - 1) = reduced.participation.transpose();
  wheel.stiffness = wheel.damping = Eigen::MatrixXd::Zero(n, n);
  wheel.stiffness.diagonal().tail(n - 1) = reduced.circular_squared;
  wheel.damping.diagonal().tail(n - 1) = settings.solid.loss_factor * reduced.circular_squared.cwiseSqrt();
  wheel.contact = Eigen::VectorXd::Ones(n);
  wheel.contact.tail(n - 1) = reduced.contact;
  wheel.load = settings.static_load * Eigen::VectorXd::Unit(n, 0);
  wheel.rigid = Eigen::VectorXd::Unit(n, 0);
  wheel.local_flexibility = reduced.local_flexibility;
  add_suspension(wheel, settings);
  return wheel;
}

WheelModel build_wheel(const WheelSettings& settings) {
  return settings.kind == WheelKind::solid ? solid_wheel(settings) : mass_wheel(settings);
}

}  // namespace fem
