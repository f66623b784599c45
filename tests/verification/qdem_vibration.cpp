// V5 longitudinal vibration of a free bar, V10 cantilever against an implicit finite-element model of its own.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>

#include "tests/support/box_mesh.hpp"
#include "tests/support/linear_fem.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/vibration.hpp"

using Eigen::Vector3d;
using Eigen::VectorXd;
using tests::near_rel;

namespace {

constexpr double bar_length = 2.0;  ///< [m]

/// A free bar that is set in motion in its first longitudinal mode.
void expect_bar_frequency(const qdem::Model& model) {
  const double expected = std::sqrt(40e9 / 2400) / (2 * bar_length);
  tests::MotionShape shape;
  for (const Vector3d& node : model.shape(0).nodes) shape.emplace_back(std::cos(M_PI * node[0] / bar_length), 0, 0);
  const double found = tests::frequency(tests::vibration(model, shape, 6 / expected));
  std::cout << "first longitudinal frequency " << found << " Hz\n";
  EXPECT_TRUE(near_rel(found, expected, 0.005));
}

}  // namespace

TEST(V5, FirstLongitudinalFrequencyOfAFreeBar) {
  expect_bar_frequency(
      tests::free_bodies(tests::box_template({24, 3, 2}, {bar_length, 0.24, 0.17}), tests::concrete()));
}

TEST(V5, FirstLongitudinalFrequencyOfABondedBar) {
  const auto shape = tests::box_template({24, 4, 2}, {bar_length, 0.24, 0.17}, 0.0, tests::Cut::mirrored);
  expect_bar_frequency(tests::free_bodies(shape, tests::bonded(tests::concrete())));
}

TEST(V10, CantileverMatchesImplicitFiniteElements) {
  // A root held at x = 0, gravity switched on at t = 0 (strong, so that the motion is far above round-off).
  const Vector3d size(0.2, 0.02, 0.02), gravity(0, 0, -200.0);
  auto mesh = tests::box_mesh({16, 2, 2}, size);
  tests::distort(mesh, 8e-4);
  for (auto& node : mesh.nodes) {
    if (node[0] < 2e-3) node[0] = 0;
  }
  auto model = tests::free_bodies(qdem::make_template("cantilever", mesh.nodes, mesh.tets), tests::rock());
  model.gravity = gravity;
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    if (mesh.nodes[i][0] == 0) model.fixities.push_back({0, i, 7u});
  }
  int tip = 0;
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
    if (mesh.nodes[i][0] > mesh.nodes[tip][0]) tip = i;
  }
  const double end = 6e-3;
  const int samples = 2000, sub_steps = 6;

  // Implicit: average acceleration, held components by a stiff diagonal.
  const tests::LinearFem fem(mesh.nodes, mesh.tets, model.materials[0]);
  const double h = end / samples;
  Eigen::SparseMatrix<double> system = fem.stiffness;
  VectorXd load = fem.mass, free = VectorXd::Ones(fem.mass.size());
  for (int i = 0; i < load.size(); ++i) load[i] *= gravity[i % 3];
  for (const auto& held : model.fixities) free.segment<3>(3 * held.node).setZero();
  for (int i = 0; i < free.size(); ++i) {
    system.coeffRef(i, i) += 4 / (h * h) * fem.mass[i] + (free[i] > 0 ? 0.0 : 1e6 * fem.stiffness.coeff(i, i));
  }
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(system);
  VectorXd u = VectorXd::Zero(load.size()), v = u;
  VectorXd a = load.cwiseQuotient(fem.mass).cwiseProduct(free);

  qdem::State state = qdem::make_state(model, {{}});
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  ASSERT_LT(h / sub_steps, qdem::largest_stable_step(qdem::template_rates(model.templates[0], model.materials[0])));
  double largest = 0, difference = 0;
  std::vector<double> explicit_tip, implicit_tip;
  for (int n = 0; n < samples; ++n) {
    const VectorXd right = load + fem.mass.cwiseProduct(4 / (h * h) * u + 4 / h * v + a);
    const VectorXd next = solver.solve(right);
    const VectorXd next_a = 4 / (h * h) * (next - u) - 4 / h * v - a;
    v += 0.5 * h * (a + next_a), u = next, a = next_a;
    engine.advance(state, h / sub_steps, sub_steps);
    const double tip_explicit = state.position(model, 0, tip)[2] - mesh.nodes[tip][2];
    explicit_tip.push_back(tip_explicit), implicit_tip.push_back(u[3 * tip + 2]);
    largest = std::max(largest, std::abs(u[3 * tip + 2]));
    difference = std::max(difference, std::abs(tip_explicit - u[3 * tip + 2]));
  }
  const auto lowest = [](const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); };
  const auto period = [&](std::vector<double> values) {  // zero crossings about the mean deflection
    double mean = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    for (double& value : values) value -= mean;
    return 1 / tests::frequency({values, h});
  };
  std::cout << "amplitude ratio " << lowest(explicit_tip) / lowest(implicit_tip) << ", period ratio "
            << period(explicit_tip) / period(implicit_tip) << ", largest difference over amplitude "
            << difference / largest << ", deflection " << largest << " m\n";
  EXPECT_TRUE(near_rel(lowest(explicit_tip), lowest(implicit_tip), 1e-3));
  EXPECT_TRUE(near_rel(period(explicit_tip), period(implicit_tip), 1e-3));
}
