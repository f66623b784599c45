// Two stones meet without friction and damping: energy, momentum and angular momentum are kept through the impact.
#include <cstdio>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/contact_scene.hpp"

namespace {

using namespace tests;
using Eigen::Vector3d;

struct Momenta {
  Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
};

Momenta momenta(const qdem::Model& model, const qdem::State& state) {
  Momenta sum;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    for (int i = 0; i < model.shape(b).n_nodes(); ++i) {
      const Vector3d p = model.node_mass(b, i) * state.velocity(model, b, i);
      sum.linear += p;
      sum.angular += state.position(model, b, i).cross(p);
    }
  }
  return sum;
}

struct Meeting {
  qdem::ContactShape shape;
  int orientation;
};

class Impact : public ::testing::TestWithParam<Meeting> {};

TEST_P(Impact, ConservesEnergyAndMomenta) {
  qdem::Model model = model_of_boxes(2, 0.0, 0.0);
  model.gravity.setZero();
  const bool spheres = GetParam().shape == qdem::ContactShape::sphere;
  model.contact.shape = GetParam().shape;
  if (spheres) model.contact.rounding = 8e-3;
  std::mt19937_64 random(50 + GetParam().orientation);
  const Vector3d aim = in_cube(random, 0.01) + Vector3d(spheres ? 0.095 : 0.085, 0, 0);
  qdem::State state = make_state(model, {{turn(random), Vector3d::Zero()}, {turn(random), aim}});
  for (int b = 0; b < 2; ++b) {
    for (int i = 0; i < model.shape(b).n_nodes(); ++i) {
      qdem::State::scatter(model, state.v, b, i, Vector3d(b == 0 ? 0.5 : -0.5, 0, 0));
    }
  }
  qdem::Engine engine(model);
  engine.prepare(state);
  ASSERT_EQ(engine.contacts().report(state).live, 0) << "the stones start apart";
  const double dt = 0.5 * qdem::StepBound(model).at(state, engine.contacts(), qdem::near_gap(model.contact));
  const auto total = [&] {
    const auto energies = engine.energies(state);
    return energies.kinetic + energies.strain + engine.contacts().report(state).elastic_energy;
  };
  const double before = total();
  const Momenta start = momenta(model, state);
  bool touched = false;
  double worst = 0;
  while (state.step < 100000) {
    engine.advance(state, dt, 200);
    touched = touched || engine.contacts().report(state).live > 0;
    worst = std::max(worst, std::abs(total() / before - 1));
  }
  ASSERT_TRUE(touched);
  const Momenta end = momenta(model, state);
  const double mass = model.body_mass(0) + model.body_mass(1);
  std::printf("energy: worst %.2e, at the end %.2e\n", worst, total() / before - 1);
  EXPECT_LT(worst, 1e-3);
  EXPECT_LT((end.linear - start.linear).norm(), 1e-11 * mass);
  EXPECT_LT((end.angular - start.angular).norm(), 1e-11 * mass * 0.1);
}

std::vector<Meeting> meetings(qdem::ContactShape shape) {
  std::vector<Meeting> all;
  for (int orientation = 0; orientation < 4; ++orientation) all.push_back({shape, orientation});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Orientations, Impact, ::testing::ValuesIn(meetings(qdem::ContactShape::facet)));
INSTANTIATE_TEST_SUITE_P(Spheres, Impact, ::testing::ValuesIn(meetings(qdem::ContactShape::sphere)));

}  // namespace
