// Contact spheres: their size, the law between two of them, conservation, candidates, history, determinism.
#include <omp.h>

#include <algorithm>
#include <cstring>

#include "qdem_solver/contact/candidates.hpp"
#include "qdem_solver/contact/sphere_pair.hpp"
#include "qdem_solver/contact/sphere_radii.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/contact_scene.hpp"

namespace {

using namespace tests;
using Eigen::Vector3d;

/// Boxes of 8 cells with spheres that nearly close their faces.
qdem::Model model_of_spheres(int n_bodies, qdem::SphereRadii radii = qdem::SphereRadii::by_edge) {
  qdem::Model model = model_of_boxes(n_bodies);
  model.contact.shape = qdem::ContactShape::sphere;
  model.contact.radii = radii;
  model.contact.rounding = 12e-3;
  model.contact.skin = 1e-3;
  model.contact.rolling_friction = 0.1;
  return model;
}

qdem::Plane slope() {
  return {"slope", {0, 0, -0.03}, Vector3d(0.2, -0.1, 1).normalized(), Vector3d::Zero(), 0.5, true, true};
}

TEST(SphereRadii, OfEqualSpheresAndByEdge) {
  const auto box = box_template({2, 2, 2}, 1);  // edges of length 2, diagonals in all faces
  qdem::ContactLaw law;
  law.rounding = 0.7;
  for (const double radius : sphere_radii(law, box)) EXPECT_EQ(radius, 0.7);
  law.radii = qdem::SphereRadii::by_edge;
  for (const double radius : sphere_radii(law, box)) EXPECT_TRUE(near_rel(radius, 0.7, 1e-14));  // a diagonal at each
  const auto fine = box_template({2, 2, 1}, 2);
  const auto radii = sphere_radii(law, fine);
  double mean = 0.0;
  for (const int node : fine.surface_nodes) mean += radii[node] / static_cast<double>(fine.surface_nodes.size());
  EXPECT_TRUE(near_rel(mean, 0.7, 1e-14));
  EXPECT_EQ(radii[13], 0.0);  // the centre
}

TEST(SphereRadii, CloseASkinWhenTheyReachTheMiddleOfTheLongestEdge) {
  // Right triangles: the point farthest from all corners is the middle of the diagonal.
  qdem::Model model = model_of_spheres(1, qdem::SphereRadii::equal);
  model.templates = {box_template({0.04, 0.04, 0.04}, 1)};
  const double half_diagonal = model.bodies[0].scale * 0.02 * std::sqrt(2.0);
  model.contact.rounding = 1.001 * half_diagonal;
  EXPECT_EQ(open_facets(model), 0.0);
  model.contact.rounding = 0.999 * half_diagonal;
  EXPECT_EQ(open_facets(model), 1.0);
}

TEST(RollingLaw, TurnsASpringUpToTheLimitAndSlides) {
  qdem::ContactLaw law;
  law.normal_stiffness = 1e6, law.rolling_friction = 0.2;
  const qdem::RollingLaw functor(law);
  qdem::Rolling rolling;
  rolling.normal = Vector3d::UnitZ(), rolling.radius = 0.01, rolling.inertia = 1e-4, rolling.normal_force = 50;
  rolling.relative_spin = {1, 0, 5};  // twist is not resisted
  const double stiffness = 2.25 * 1e6 * 0.2 * 0.01 * 0.2 * 0.01;
  EXPECT_TRUE(near_rel(functor.stiffness(0.01), stiffness, 1e-14));
  Vector3d roll = Vector3d::Zero();
  qdem::RollingCouple couple;
  for (int i = 0; i < 10; ++i) couple = functor.push(rolling, roll, 1e-4), roll = couple.roll;
  EXPECT_TRUE(near_rel(couple.couple[0], -stiffness * 1e-3, 1e-12));
  EXPECT_EQ(couple.couple[2], 0.0);
  for (int i = 0; i < 1000; ++i) couple = functor.push(rolling, roll, 1e-3), roll = couple.roll;
  EXPECT_TRUE(near_rel(couple.couple[0], -0.2 * 0.01 * 50, 1e-12));
  rolling.relative_spin = -rolling.relative_spin;  // the reset spring answers a reversal at once
  couple = functor.push(rolling, roll, 1e-5);
  EXPECT_TRUE(near_rel(couple.couple[0], -0.1 + stiffness * 1e-5, 1e-12));
  law.damping_ratio = 0.3;
  couple = qdem::RollingLaw(law).push(rolling, Vector3d::Zero(), 0.0);
  EXPECT_TRUE(near_rel(couple.couple[0], 0.6 * std::sqrt(1e-4 * stiffness), 1e-12));
}

TEST(SphereContacts, ConserveMomentumAndAngularMomentum) {
  const qdem::Model model = model_of_spheres(30);
  std::mt19937_64 random(4);
  qdem::State state = strewn(model, random, 0.09, 1.0);
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  for (int i = 0; i < 3; ++i) stage.compute(state, 1e-5);
  EXPECT_GT(stage.report(state).live, 100);
  double rolled = 0.0, slipped = 0.0;
  for (std::size_t i = 0; i < state.contact.keys.size(); ++i) {
    rolled += state.contact.roll[i].norm(), slipped += state.contact.slip[i].norm();
  }
  EXPECT_GT(rolled, 0.0);
  EXPECT_GT(slipped, 0.0);
  const auto sum = resultant(model, state, stage);
  EXPECT_LT(sum.force.norm(), 1e-12 * sum.size);
  EXPECT_LT(sum.moment.norm(), 1e-12 * sum.size * 0.1);
}

TEST(SphereContacts, TakeFromTheParticlesWhatTheirSpringsGain) {
  // Nothing slides and there are no dashpots: the power of the forces is the rate of the springs' energy, negative.
  qdem::Model model = model_of_spheres(30);
  model.contact.friction = 1e6, model.contact.rolling_friction = 1, model.contact.damping_ratio = 0;
  std::mt19937_64 random(8);
  qdem::State state = strewn(model, random, 0.09, 1.0);
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  for (int i = 0; i < 3; ++i) stage.compute(state, 1e-7);
  const double before = stage.report(state).elastic_energy;
  std::vector<double> force(state.x.size(), 0.0);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) stage.gather(static_cast<int>(b), force);
  double power = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) power += force[i] * state.v[i];
  const double dt = 1e-9;
  for (std::size_t i = 0; i < force.size(); ++i) state.x[i] += dt * state.v[i];
  stage.update_candidates(state, std::vector<double>(model.bodies.size(), 2 * dt));
  stage.compute(state, dt);
  EXPECT_TRUE(near_rel((stage.report(state).elastic_energy - before) / dt, -power, 1e-5));
}

TEST(SphereContacts, TheCoupleOfATangentialForceReachesTheBody) {
  // A box slides over a plane: the force of friction acts in the plane, a sphere's radius below the particles.
  qdem::Model model = model_of_spheres(1, qdem::SphereRadii::equal);
  model.contact.rolling_friction = 0.0, model.contact.damping_ratio = 0.0;
  model.planes.push_back({"ground", {0, 0, 0}, Vector3d::UnitZ(), Vector3d::Zero(), 0.5, true, true});
  const double half = 0.02 * model.bodies[0].scale, overlap = 1e-4, radius = model.contact.rounding;
  qdem::State state = make_state(model, {{Eigen::Matrix3d::Identity(), {0, 0, half + radius - overlap}}});
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) qdem::State::scatter(model, state.v, 0, i, {1, 0, 0});
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  stage.compute(state, 1.0);  // slides at once
  const auto sum = resultant(model, state, stage);
  const double weight = 9 * 1e6 * overlap;
  EXPECT_TRUE(near_rel(sum.force[2], weight, 1e-9));
  EXPECT_TRUE(near_rel(sum.force[0], -0.5 * weight, 1e-9));
  EXPECT_TRUE(near_abs(sum.moment.norm(), 0.0, 1e-9 * weight));  // about a point in the plane, under the centre
}

/// Every pair of spheres nearer than `skin`, by trying all of them.
std::vector<qdem::ContactKey> brute_force(const qdem::Model& model, const qdem::State& state, double skin) {
  std::vector<qdem::ContactKey> keys;
  const int n = static_cast<int>(model.bodies.size());
  const auto radii = sphere_radii(model.contact, model.templates[0]);
  for (int a = 0; a < n; ++a) {
    for (const int i : model.shape(a).surface_nodes) {
      const Vector3d x = state.position(model, a, i);
      for (int p = 0; p < static_cast<int>(model.planes.size()); ++p) {
        const auto& plane = model.planes[p];
        if (plane.normal.dot(x - plane.point) - radii[i] <= skin) keys.push_back({a, ~p, i, -1});
      }
      for (int b = a + 1; b < n; ++b) {
        for (const int j : model.shape(b).surface_nodes) {
          const double distance = (x - state.position(model, b, j)).norm();
          if (distance - radii[i] - radii[j] <= skin) keys.push_back({a, b, i, j});
        }
      }
    }
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

TEST(SphereCandidates, AgreeWithBruteForce) {
  for (const auto radii : {qdem::SphereRadii::equal, qdem::SphereRadii::by_edge}) {
    qdem::Model model = model_of_spheres(12, radii);
    model.planes.push_back(slope());
    const auto skins = qdem::make_skins(model);
    for (int seed = 0; seed < 5; ++seed) {
      std::mt19937_64 random(100 + seed);
      const qdem::State state = strewn(model, random, 0.07, 0);
      const auto list = find_candidates(model, skins, state.x.data(), 2e-3, 0);
      const auto expected = brute_force(model, state, 2e-3);
      EXPECT_GT(expected.size(), 100u);
      ASSERT_TRUE(list.keys == expected);
      ASSERT_EQ(list.triangle_offsets.size(), list.keys.size() + 1);
    }
  }
}

TEST(SphereContacts, DegeneratePairsGiveFiniteForces) {
  const qdem::Model model = model_of_spheres(2, qdem::SphereRadii::equal);
  const double r = model.contact.rounding;
  const Vector3d corner = 0.5 * (model.bodies[0].scale + model.bodies[1].scale) * Vector3d(0.06, 0.05, 0.04);
  // Corner on corner: concentric, inside each other, just touching; the same place.
  for (const Vector3d& shift :
       {corner, Vector3d(corner + Vector3d(0, 0, 1e-9)), Vector3d(corner + Vector3d(0, 2 * r, 0)), Vector3d(0, 0, 0)}) {
    finite_resultant(model, shift);
  }
  const auto concentric = qdem::meet({1, 2, 3}, 0.1, {1, 2, 3}, 0.3);
  EXPECT_TRUE(near_rel(concentric.gap, -0.4, 1e-14));
  EXPECT_TRUE(near_abs(concentric.arm_a + concentric.arm_b, 0.0, 1e-15));
}

TEST(SphereContacts, ThreadsDoNotChangeAByte) {
  expect_same_bytes_by_threads(model_of_spheres(60), 0.13);
}

TEST(SphereContacts, SlipAndRollSurviveARebuild) {
  const qdem::Model model = model_of_spheres(30);
  std::mt19937_64 random(7);
  qdem::State state = strewn(model, random, 0.09, 1.0);
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  stage.compute(state, 1e-5);
  const auto before = state.contact;
  EXPECT_TRUE(stage.update_candidates(state, std::vector<double>(model.bodies.size(), 0.6e-3)));
  EXPECT_TRUE(state.contact.keys == before.keys);  // nothing moved
  double size = 0;
  for (std::size_t i = 0; i < before.roll.size(); ++i) {
    EXPECT_EQ((state.contact.slip[i] - before.slip[i]).norm(), 0);
    EXPECT_EQ((state.contact.roll[i] - before.roll[i]).norm(), 0);
    size += before.roll[i].norm();
  }
  EXPECT_GT(size, 0);
}

TEST(SphereRates, AContactWithAPlane) {
  qdem::Model model = model_of_spheres(1, qdem::SphereRadii::equal);
  model.contact.rolling_friction = 0.0;
  model.planes.push_back({"ground", {0, 0, 0}, Vector3d::UnitZ(), Vector3d::Zero(), 0.0, true, true});
  const double half = 0.02 * model.bodies[0].scale;
  qdem::State state = make_state(model, {{Eigen::Matrix3d::Identity(), {0, 0, half + model.contact.rounding}}});
  const auto particle = [&] {
    qdem::ContactStage stage(model);
    stage.update_candidates(state);
    return stage.rates(state, 1e-6)[0].particle.stiffness;
  };
  double lightest = model.node_mass(0, 0);
  for (int i = 0; i < 9; ++i) lightest = std::min(lightest, model.node_mass(0, i));  // the bottom nodes come first
  const double smooth = particle();
  EXPECT_TRUE(near_rel(smooth, model.contact.normal_stiffness / lightest, 1e-12));
  model.planes[0].friction = 0.5;  // now the body turns with it
  EXPECT_GT(particle(), smooth);
}

}  // namespace
