// V4: the largest stable step, and second order in time with dashpots at the force's own time level.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "proto/error.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/tolerance.hpp"

using tests::near_rel;

namespace {

constexpr double cube = 0.005;  // edge [m]

double wave_speed(const qdem::Material& m) {
  return std::sqrt((m.lambda() + 2 * m.mu()) / m.density);
}

/// Noise of round-off size grows without bound above the limit and stays below it.
bool is_stable(const qdem::Model& model, double dt) {
  qdem::State state = qdem::make_state(model, {{}});
  std::mt19937_64 random(7);
  for (double& v : state.v) v = 1e-6 * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  try {
    for (int i = 0; i < 60; ++i) {
      engine.advance(state, dt, 100);
      if (!(engine.largest_speed(state) < 1e-5)) return false;
    }
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::numerics);
    return false;
  }
  return true;
}

double bisected_limit(const qdem::Model& model, double low, double high) {
  EXPECT_TRUE(is_stable(model, low));
  EXPECT_FALSE(is_stable(model, high));
  while (high - low > 2e-3 * low) {
    const double middle = 0.5 * (low + high);
    (is_stable(model, middle) ? low : high) = middle;
  }
  return low;
}

qdem::Model rock_cube(double tau) {
  return tests::free_bodies(tests::box_template({6, 6, 6}, Eigen::Vector3d::Constant(6 * cube)),
                            tests::with_retardation(tests::rock(), tau));
}

/// Largest modulus of the integrator's amplification matrix for x'' + 2 xi w x' + w^2 x = 0, w = 1.
double amplification(double dt, double xi) {
  Eigen::Matrix3d step;  // (x, v, a) -> next
  const double c = 2 * xi;
  const Eigen::RowVector3d x(1, dt, dt * dt / 2), predicted(0, 1, dt), a = -x - c * predicted;
  step << x, Eigen::RowVector3d(0, 1, dt / 2) + dt / 2 * a, a;
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

TEST(V4, LimitOfTheIntegratorForOneDampedMode) {
  for (const double xi : {0.0, 0.01, 0.1, 0.3, 1.0, 3.0}) {
    const double limit = qdem::largest_stable_step({1.0, 2 * xi});
    EXPECT_TRUE(near_rel(limit, 2 * (std::sqrt(1 + 4 * xi * xi) - 2 * xi), 1e-12));
    for (double share = 0.02; share < 0.9995; share += 0.02) {
      EXPECT_LE(amplification(share * limit, xi), 1 + 1e-9) << "xi " << xi << ", share " << share;
    }
    EXPECT_LE(amplification(0.999 * limit, xi), 1 + 1e-9) << xi;
    EXPECT_GT(amplification(1.001 * limit, xi), 1 + 1e-4) << xi;
  }
}

TEST(V4, LimitOnACubeMesh) {
  const auto model = rock_cube(0.0);
  const double unit = cube / wave_speed(model.materials[0]);
  const double limit = bisected_limit(model, 0.5 * unit, 0.8 * unit);
  std::cout << "limit " << limit / unit << " h/c_p\n";
  EXPECT_TRUE(tests::near_abs(limit / unit, 0.675, 0.015 + 0.03 * 0.675));
  const double computed = qdem::largest_stable_step(qdem::template_rates(model.templates[0], model.materials[0]));
  EXPECT_TRUE(near_rel(computed, limit, 0.01));
  const double cheap = qdem::largest_stable_step(qdem::quadruple_rates(model.templates[0], model.materials[0]));
  EXPECT_TRUE(near_rel(cheap, 0.408 * unit, 0.01));
}

TEST(V4, LimitOfBonds) {
  for (const double tau : {0.0, 1e-6}) {
    const auto model = tests::free_bodies(tests::box_template({6, 6, 6}, Eigen::Vector3d::Constant(6 * cube)),
                                          tests::bonded(tests::with_retardation(tests::rock(), tau)));
    const double computed = qdem::largest_stable_step(qdem::template_rates(model.templates[0], model.materials[0]));
    const double limit = bisected_limit(model, 0.8 * computed, 1.2 * computed);
    std::cout << "bonds, tau " << tau << ": limit " << limit << " s, computed " << computed << " s\n";
    EXPECT_TRUE(near_rel(computed, limit, 0.01));
  }
}

TEST(V4, LimitWithVoigtDamping) {
  for (const double tau : {1e-7, 1e-6}) {
    const auto model = rock_cube(tau);
    const double computed = qdem::largest_stable_step(qdem::template_rates(model.templates[0], model.materials[0]));
    const double limit = bisected_limit(model, 0.8 * computed, 1.2 * computed);
    std::cout << "tau " << tau << ": limit " << limit << " s, computed " << computed << " s\n";
    EXPECT_TRUE(near_rel(computed, limit, 0.03));
  }
}

/// A cube that lies on another, which lies on the ground: the contacts, not the elements, limit the step. With facets
/// it lies turned and shifted, with spheres particle on particle.
class PressedCubes {
 public:
  PressedCubes(double damping_ratio, qdem::ContactShape shape)
      : model_(tests::free_bodies(tests::box_template({2, 2, 2}, Eigen::Vector3d::Constant(0.04)), tests::rock(), 2)) {
    model_.materials[0].young *= 1e-3;
    const bool facets = shape == qdem::ContactShape::facet;
    const double rounding = facets ? 1e-3 : 12e-3;
    model_.contact = {1e7, 0.8, damping_ratio, 100.0, rounding};
    model_.contact.shape = shape, model_.contact.rolling_friction = 0.1;
    model_.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 100.0});
    model_.gravity = {0, 0, -9.81};
    qdem::make_batches(model_);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(facets ? 0.35 : 0.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const double shift = facets ? 0.005 : 0.0;
    state_ = qdem::make_state(model_, {{Eigen::Matrix3d::Identity(), {0, 0, rounding - overlap}},
                                       {turn, {shift, -shift, 0.04 + 3 * rounding - 2 * overlap}}});
  }

  double computed() {
    qdem::Engine engine(model_, {1});
    engine.prepare(state_);
    return qdem::StepBound(model_).at(state_, engine.contacts(), qdem::near_gap(model_.contact));
  }

  /// What the overlaps hold at the beginning does not grow; with dashpots it dies out. (They leave a rattle of some
  /// 1e-5 of it, the same at a tenth of the step.)
  bool is_stable(double dt) const {
    qdem::State state = state_;
    qdem::Engine engine(model_, {1});
    engine.prepare(state);
    const double held = engine.contacts().report(state).elastic_energy;
    const auto n_steps = static_cast<std::int64_t>(duration / dt / 20);
    double kinetic = 0.0;
    try {
      for (int i = 0; i < 20; ++i) {
        engine.advance(state, dt, n_steps);
        kinetic = engine.kinetic_energy(state);
        if (!(kinetic < 3 * held)) return false;
      }
    } catch (const proto::Error&) {
      return false;
    }
    return model_.contact.damping_ratio == 0 || kinetic < 1e-3 * held;
  }

 private:
  static constexpr double overlap = 1e-5;  ///< [m]
  static constexpr double duration = 0.1;  ///< [s]
  qdem::Model model_;
  qdem::State state_;
};

namespace {

void expect_a_bound(qdem::ContactShape shape) {
  for (const double zeta : {0.0, 0.2}) {
    PressedCubes cubes(zeta, shape);
    const double computed = cubes.computed();
    double share = 1.0;
    while (share < 8 && cubes.is_stable(share * computed)) share *= 1.1;
    std::cout << "damping ratio " << zeta << ": computed " << computed << " s, stable up to " << share << " of it\n";
    EXPECT_GT(share, 1.0) << "the bound is no bound";
    EXPECT_LT(share, 5.0) << "the bound wastes steps";
  }
}

}  // namespace

TEST(V4, LimitWithContacts) {
  expect_a_bound(qdem::ContactShape::facet);
}

TEST(V4, LimitWithContactSpheres) {
  expect_a_bound(qdem::ContactShape::sphere);
}

TEST(TimeIntegration, SecondOrderWithDamping) {
  // A bar in its damped free vibration, far below the stability limit; the reference is the finest step, four times
  // finer than the next, which shifts the fitted order by less than 0.03.
  const auto model = tests::free_bodies(tests::box_template({6, 1, 1}, {6 * cube, cube, cube}),
                                        tests::with_retardation(tests::rock(), 3e-7));
  const double end = 2e-5;
  const auto solve = [&](int steps) {
    qdem::State state = qdem::make_state(model, {{}});
    for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
      const double x = state.position(model, 0, i)[0] / (6 * cube);
      qdem::State::scatter(model, state.v, 0, i, {0.1 * std::cos(M_PI * x), 0.02 * x * x, 0});
    }
    qdem::Engine engine(model, {1});
    engine.prepare(state);
    engine.advance(state, end / steps, steps);
    return state;
  };
  const qdem::State reference = solve(12800);
  std::vector<double> steps, errors;
  for (const int n : {200, 400, 800, 1600}) {
    const qdem::State state = solve(n);
    double error = 0.0;
    for (std::size_t i = 0; i < state.v.size(); ++i) error = std::max(error, std::abs(state.v[i] - reference.v[i]));
    steps.push_back(end / n), errors.push_back(error);
  }
  std::cout << "order " << tests::fitted_order(steps, errors) << "\n";
  EXPECT_TRUE(tests::converges_with_order(steps, errors, 2.0, 0.1));
}
