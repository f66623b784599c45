// V5 longitudinal vibration of a free bar, V10 cantilever against an implicit finite-element model of its own.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using tests::near_rel;

namespace {

qdem::Material concrete() {
  return {"concrete", 40e9, 0.2, 2400.0, 0.0, 0.0};
}

/// Frequency [Hz] from the upward zero crossings of a sampled signal.
double frequency(const std::vector<double>& signal, double interval) {
  std::vector<double> crossings;
  for (std::size_t i = 1; i < signal.size(); ++i) {
    if (signal[i - 1] >= 0 || signal[i] < 0) continue;
    crossings.push_back((static_cast<double>(i) - signal[i] / (signal[i] - signal[i - 1])) * interval);
  }
  return (static_cast<double>(crossings.size()) - 1) / (crossings.back() - crossings.front());
}

/// Linear elastic tetrahedra with lumped masses, assembled here from shape functions and Hooke's law in Voigt notation:
/// no code of the solver.
struct LinearFem {
  Eigen::SparseMatrix<double> stiffness;
  VectorXd mass;

  LinearFem(const std::vector<Vector3d>& nodes, const std::vector<std::array<int, 4>>& tets, const qdem::Material& m)
      : stiffness(3 * nodes.size(), 3 * nodes.size()), mass(VectorXd::Zero(3 * nodes.size())) {
    Eigen::Matrix<double, 6, 6> hooke = Eigen::Matrix<double, 6, 6>::Zero();
    const double c = m.young / ((1 + m.poisson) * (1 - 2 * m.poisson));
    hooke.topLeftCorner<3, 3>().setConstant(c * m.poisson);
    for (int i = 0; i < 3; ++i) hooke(i, i) = c * (1 - m.poisson), hooke(i + 3, i + 3) = c * (0.5 - m.poisson);
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& tet : tets) {
      Eigen::Matrix4d corners;  // rows 1, x, y, z: its inverse holds the shape functions
      for (int k = 0; k < 4; ++k) corners.row(k) << 1, nodes[tet[k]].transpose();
      const Eigen::Matrix4d shape = corners.inverse();
      const double volume = corners.determinant() / 6;
      Eigen::Matrix<double, 6, 12> b = Eigen::Matrix<double, 6, 12>::Zero();
      for (int k = 0; k < 4; ++k) {
        const double x = shape(1, k), y = shape(2, k), z = shape(3, k);
        b.block<6, 3>(0, 3 * k) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
        for (int i = 0; i < 3; ++i) mass[3 * tet[k] + i] += m.density * volume / 4;
      }
      const Eigen::Matrix<double, 12, 12> local = volume * b.transpose() * hooke * b;
      for (int i = 0; i < 12; ++i) {
        for (int j = 0; j < 12; ++j) {
          entries.emplace_back(3 * tet[i / 3] + i % 3, 3 * tet[j / 3] + j % 3, local(i, j));
        }
      }
    }
    stiffness.setFromTriplets(entries.begin(), entries.end());
  }
};

constexpr double bar_length = 2.0;  ///< [m]

/// Of a free bar that is set in motion in its first longitudinal mode [Hz].
double longitudinal_frequency(const qdem::Model& model) {
  qdem::State state = qdem::make_state(model, {{}});
  VectorXd shape(model.shape(0).n_nodes());
  for (int i = 0; i < shape.size(); ++i) {
    shape[i] = std::cos(M_PI * model.shape(0).nodes[i][0] / bar_length);
    qdem::State::scatter(model, state.v, 0, i, {1e-3 * shape[i], 0, 0});
  }
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  const double dt = 0.5 * qdem::largest_stable_step(qdem::template_rates(model.templates[0], model.materials[0]));
  std::vector<double> signal;
  for (int step = 0; step * dt < 6e-3; ++step) {
    engine.advance(state, dt, 1);
    double amplitude = 0;
    for (int i = 0; i < shape.size(); ++i) {
      amplitude += model.node_mass(0, i) * shape[i] * state.velocity(model, 0, i)[0];
    }
    signal.push_back(amplitude);
  }
  return frequency(signal, dt);
}

void expect_bar_frequency(const qdem::Model& model) {
  const double found = longitudinal_frequency(model);
  std::cout << "first longitudinal frequency " << found << " Hz\n";
  EXPECT_TRUE(near_rel(found, std::sqrt(40e9 / 2400) / (2 * bar_length), 0.005));
}

}  // namespace

TEST(V5, FirstLongitudinalFrequencyOfAFreeBar) {
  expect_bar_frequency(tests::free_bodies(tests::box_template({24, 3, 2}, {bar_length, 0.24, 0.17}), concrete()));
}

TEST(V5, FirstLongitudinalFrequencyOfABondedBar) {
  const auto shape = tests::box_template({24, 4, 2}, {bar_length, 0.24, 0.17}, 0.0, tests::Cut::mirrored);
  expect_bar_frequency(tests::free_bodies(shape, tests::bonded(concrete())));
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
  const LinearFem fem(mesh.nodes, mesh.tets, model.materials[0]);
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
    return 1 / frequency(values, h);
  };
  std::cout << "amplitude ratio " << lowest(explicit_tip) / lowest(implicit_tip) << ", period ratio "
            << period(explicit_tip) / period(implicit_tip) << ", largest difference over amplitude "
            << difference / largest << ", deflection " << largest << " m\n";
  EXPECT_TRUE(near_rel(lowest(explicit_tip), lowest(implicit_tip), 1e-3));
  EXPECT_TRUE(near_rel(period(explicit_tip), period(implicit_tip), 1e-3));
}
