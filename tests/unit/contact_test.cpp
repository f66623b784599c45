// Contact kernels and the contact stage: geometry against sampling, the law, conservation, candidates, determinism.
#include <omp.h>

#include <cstring>
#include <string>

#include "proto/error.hpp"
#include "qdem_solver/contact/candidates.hpp"
#include "qdem_solver/contact/edge_pair.hpp"
#include "qdem_solver/contact/entry_force.hpp"
#include "qdem_solver/contact/initial_overlap.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/unit/contact_scene.hpp"

namespace {

using namespace tests;
using Eigen::Vector3d;

TEST(ClosestPoint, TriangleAgreesWithSampling) {
  std::mt19937_64 random(1);
  constexpr int n = 200;
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d a = in_cube(random, 1), b = in_cube(random, 1), c = in_cube(random, 1), p = in_cube(random, 2);
    double sampled = 1e9;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        sampled = std::min(sampled, (p - a - i * (b - a) / n - j * (c - a) / n).norm());
      }
    }
    const auto found = qdem::closest_on_triangle(p, a, b, c, (b - a).cross(c - a));
    const Vector3d point = found.weights[0] * a + found.weights[1] * b + found.weights[2] * c;
    EXPECT_NEAR((p - point - found.offset).norm(), 0, 1e-12);
    EXPECT_LE(found.distance2, (sampled + 1e-12) * (sampled + 1e-12));
    const double pitch = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()}) / n;
    EXPECT_TRUE(near_abs(std::sqrt(found.distance2), sampled, pitch));
    EXPECT_GE(found.weights.minCoeff(), -1e-15);
    EXPECT_NEAR(found.weights.sum(), 1, 1e-14);
  }
}

TEST(ClosestPoint, SegmentsAgreeWithSampling) {
  std::mt19937_64 random(2);
  constexpr int n = 300;
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d a = in_cube(random, 1), b = in_cube(random, 1), c = in_cube(random, 1), d = in_cube(random, 1);
    double sampled = 1e9;
    for (int i = 0; i <= n; ++i) {
      const Vector3d p = a + i * (b - a) / n;
      sampled = std::min(sampled, (p - c - qdem::closest_on_segment(p, c, d) * (d - c)).norm());
    }
    const double found = std::sqrt(qdem::segment_distance2(a, b, c, d));
    EXPECT_LE(found, sampled + 1e-12);
    EXPECT_TRUE(near_abs(found, sampled, (b - a).norm() / n));
  }
}

TEST(ClosestPoint, SignedDistanceOfABoxIsItsClosedForm) {
  const qdem::Model model = model_of_boxes(1);
  const qdem::State state = make_state(model, {qdem::Placement{}});
  const auto skins = qdem::make_skins(model);
  std::vector<int> all(model.templates[0].triangles.size());
  for (std::size_t t = 0; t < all.size(); ++t) all[t] = static_cast<int>(t);
  const Vector3d half = 0.5 * model.bodies[0].scale * Vector3d(0.06, 0.05, 0.04);
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector3d p = in_cube(random, 0.05);
    const Vector3d q = p.cwiseAbs() - half;
    const double exact = q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
    const auto found = nearest_surface_point(skins[0], state.x.data(), p, all.data(), all.data() + all.size());
    EXPECT_TRUE(near_abs(found.distance, exact, 1e-14));
    EXPECT_NEAR(found.normal.norm(), 1, 1e-12);
  }
}

TEST(ContactLaw, SticksThenSlidesAtTheCoulombLimit) {
  qdem::ContactLaw law;
  law.normal_stiffness = 1e6, law.tangential_ratio = 0.5, law.friction = 0.3, law.damping_ratio = 0.0;
  const qdem::VoigtCoulombLaw functor(law, law.friction);
  qdem::Touch touch;
  touch.normal = Vector3d::UnitZ(), touch.overlap = 1e-4, touch.effective_mass = 1;
  touch.relative_velocity = {0.01, 0, 0};
  Vector3d slip = Vector3d::Zero();
  qdem::TouchForce force;
  for (int i = 0; i < 20; ++i) force = functor.push(touch, slip, 1e-5), slip = force.slip;
  EXPECT_TRUE(near_rel(force.normal, 100, 1e-12));
  EXPECT_TRUE(near_rel(force.tangential[0], -0.5e6 * 20 * 1e-7, 1e-9));
  for (int i = 0; i < 2000; ++i) force = functor.push(touch, slip, 1e-5), slip = force.slip;
  EXPECT_TRUE(near_rel(force.tangential[0], -30, 1e-12));
  touch.relative_velocity = -touch.relative_velocity;  // the reset spring answers a reversal at once
  force = functor.push(touch, slip, 1e-5);
  EXPECT_TRUE(near_rel(force.tangential[0], -30 + 0.05, 1e-9));
  touch.normal_velocity = 1e9;
  touch.overlap = 1e-4;
  qdem::ContactLaw damped = law;
  damped.damping_ratio = 0.1;
  EXPECT_EQ(qdem::VoigtCoulombLaw(damped, 0.3).push(touch, slip, 1e-5).normal, 0.0);  // never pulls
}

/// A rigid motion of body 1 about the middle of the scene that moves no node by more than `most`.
qdem::State nudged(const qdem::Model& model, const qdem::State& state, std::mt19937_64& random, double most) {
  const Vector3d shift = in_cube(random, 1.0), axis = in_cube(random, 1.0).normalized();
  const double angle = 2 * uniform(random) - 1;
  qdem::State moved = state;
  const auto move = [&](double size) {
    double farthest = 0.0;
    for (int i = 0; i < model.shape(1).n_nodes(); ++i) {
      const Vector3d x = state.position(model, 1, i);
      const Vector3d y = Eigen::AngleAxisd(30 * size * angle, axis) * x + size * shift;
      qdem::State::scatter(model, moved.x, 1, i, y);
      farthest = std::max(farthest, (y - x).norm());
    }
    return farthest;
  };
  double size = most;
  for (int k = 0; k < 4; ++k) size *= 0.999 * most / move(size);  // nearly linear
  EXPECT_LE(move(size), most);
  return moved;
}

TEST(EdgePair, DoesNotTouchBeforeItsGapIsUsedUp) {
  std::mt19937_64 random(11);
  constexpr double reach = 2e-3, longest = 0.5e-3;  // a list does not live longer
  int missed = 0, turned_away = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const qdem::Model model = model_of_boxes(2);
    const qdem::State state =
        make_state(model, {{turn(random), Vector3d::Zero()}, {turn(random), in_cube(random, 0.04)}});
    const auto skins = qdem::make_skins(model);
    for (int ea = 0; ea < static_cast<int>(skins[0].shape->edges.size()); ++ea) {
      for (int eb = 0; eb < static_cast<int>(skins[1].shape->edges.size()); ++eb) {
        const auto contact = touch_edges(skins[0], ea, skins[1], eb, state.x.data(), reach);
        const double gap = std::min(contact.gap, longest);
        if (contact.touching || !(gap > 0)) continue;
        const qdem::EdgeNow a(skins[0], state.x.data(), ea), b(skins[1], state.x.data(), eb);
        const double distance = std::sqrt(qdem::segment_distance2(a.x[0], a.x[1], b.x[0], b.x[1]));
        if (distance > reach + longest) continue;
        ++(distance < reach && contact.facing == 0 && contact.normal.norm() > 0.5 ? turned_away : missed);
        const qdem::State moved = nudged(model, state, random, gap);
        EXPECT_FALSE(touch_edges(skins[0], ea, skins[1], eb, moved.x.data(), reach).touching)
            << "gap " << gap << ", distance " << distance << ", facing " << contact.facing;
      }
    }
  }
  EXPECT_GT(missed, 1000);
  EXPECT_GT(turned_away, 20);
}

TEST(ContactStage, ConservesMomentumAndAngularMomentum) {
  const qdem::Model model = model_of_boxes(30);
  std::mt19937_64 random(4);
  qdem::State state = strewn(model, random, 0.07, 1.0);
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  for (int i = 0; i < 3; ++i) stage.compute(state, 1e-5);
  const auto report = stage.report(state);
  EXPECT_GT(report.live, 100);
  int n_edge_pairs = 0;
  for (std::size_t i = 0; i < state.contact.keys.size(); ++i) {
    n_edge_pairs += state.contact.keys[i].feature_b >= 0 && state.contact.slip[i].norm() > 0;
  }
  EXPECT_GT(n_edge_pairs, 20);
  const auto sum = resultant(model, state, stage);
  EXPECT_GT(sum.size, 1.0);
  EXPECT_LT(sum.force.norm(), 1e-12 * sum.size);
  EXPECT_LT(sum.moment.norm(), 1e-12 * sum.size * 0.1);
}

/// Every pair within reach, by trying all of them.
std::vector<qdem::ContactKey> brute_force(const qdem::Model& model, const std::vector<qdem::BodySkin>& skins,
                                          const qdem::State& state, double reach) {
  std::vector<qdem::ContactKey> keys;
  const double* x = state.x.data();
  for (int a = 0; a < static_cast<int>(skins.size()); ++a) {
    for (int p = 0; p < static_cast<int>(model.planes.size()); ++p) {
      const auto& plane = model.planes[p];
      for (const int node : model.shape(a).surface_nodes) {
        const double height = plane.normal.dot(skins[a].at(x, node) - plane.point);
        if (height <= reach - model.contact.rounding) keys.push_back({a, ~p, node, -1});
      }
    }
    for (int b = 0; b < static_cast<int>(skins.size()); ++b) {
      if (a == b) continue;
      for (const int node : model.shape(a).surface_nodes) {
        bool near = false;
        for (int t = 0; t < static_cast<int>(model.shape(b).triangles.size()); ++t) {
          const qdem::TriangleNow now(skins[b], x, t);
          const auto p = qdem::closest_on_triangle(skins[a].at(x, node), now.x[0], now.x[1], now.x[2], now.area_vector);
          near = near || p.distance2 <= reach * reach;
        }
        if (near) keys.push_back({a, b, node, -1});
      }
      if (a > b) continue;
      for (int e = 0; e < static_cast<int>(model.shape(a).edges.size()); ++e) {
        for (int f = 0; f < static_cast<int>(model.shape(b).edges.size()); ++f) {
          if (!model.shape(a).edges[e].sharp || !model.shape(b).edges[f].sharp) continue;
          const qdem::EdgeNow ea(skins[a], x, e), eb(skins[b], x, f);
          if (qdem::segment_distance2(ea.x[0], ea.x[1], eb.x[0], eb.x[1]) <= reach * reach)
            keys.push_back({a, b, e, f});
        }
      }
    }
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}

TEST(Candidates, AgreeWithBruteForce) {
  qdem::Model model = model_of_boxes(12);
  model.planes.push_back(
      {"slope", {0, 0, -0.03}, Vector3d(0.2, -0.1, 1).normalized(), Vector3d::Zero(), 0.5, true, true});
  const auto skins = qdem::make_skins(model);
  for (int seed = 0; seed < 5; ++seed) {
    std::mt19937_64 random(100 + seed);
    const qdem::State state = strewn(model, random, 0.045, 0);
    const double reach = 0.003;
    const auto list = find_candidates(model, skins, state.x.data(), reach - 2 * model.contact.rounding, 0);
    const auto expected = brute_force(model, skins, state, reach);
    EXPECT_GT(expected.size(), 100u);
    ASSERT_TRUE(list.keys == expected);
    ASSERT_EQ(list.triangle_offsets.size(), list.keys.size() + 1);
  }
}

TEST(ContactStage, DegeneratePairsGiveFiniteForces) {
  const qdem::Model model = model_of_boxes(2);
  const double h = model.bodies[0].scale, g = model.bodies[1].scale;
  // Equal faces in contact; corner on corner; edge along edge; edges that cross in a point; the same place.
  const std::vector<Vector3d> shifts = {{0, 0, 0.02 * (h + g)},
                                        {0.03 * (h + g), 0.025 * (h + g), 0.02 * (h + g)},
                                        {0.03 * (h + g), 0, 0.02 * (h + g)},
                                        {0.03 * h + 0.004, -0.025 * g + 0.003, 0.02 * (h + g)},
                                        {0, 0, 0}};
  for (const Vector3d& shift : shifts) {
    const auto sum = finite_resultant(model, shift);
    if (shift.norm() > 0) {
      EXPECT_GT(sum.size, 0);
    }
  }
}

TEST(ContactStage, ThreadsDoNotChangeAByte) {
  expect_same_bytes_by_threads(model_of_boxes(60), 0.1);
}

/// Every body moved by so much [m].
std::vector<double> moved_by(const qdem::Model& model, double distance) {
  return std::vector<double>(model.bodies.size(), distance);
}

TEST(ContactStage, SlipSurvivesARebuild) {
  const qdem::Model model = model_of_boxes(30);
  std::mt19937_64 random(7);
  qdem::State state = strewn(model, random, 0.07, 1.0);
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  stage.compute(state, 1e-5);
  const auto before = state.contact;
  EXPECT_FALSE(stage.update_candidates(state, moved_by(model, 0.4e-3)));  // under half the skin of 1 mm
  EXPECT_TRUE(stage.update_candidates(state, moved_by(model, 0.2e-3)));
  EXPECT_EQ(state.contact.rebuilds, before.rebuilds + 1);
  EXPECT_TRUE(state.contact.keys == before.keys);  // nothing moved
  double size = 0;
  for (std::size_t i = 0; i < before.slip.size(); ++i) {
    EXPECT_EQ((state.contact.slip[i] - before.slip[i]).norm(), 0);
    size += before.slip[i].norm();
  }
  EXPECT_GT(size, 0);
}

TEST(ContactStage, ARestoredStateIsComputedAfresh) {
  const qdem::Model model = model_of_boxes(2, 0.0, 0.0);
  const double touching = 0.02 * (model.bodies[0].scale + model.bodies[1].scale) + 2e-3;
  const auto state_at = [&](double height) {
    qdem::State state = make_state(model, {qdem::Placement{}, {Eigen::Matrix3d::Identity(), {0, 0, height}}});
    return state;
  };
  qdem::State state = state_at(touching - 0.1e-3);
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  qdem::State moved = state;
  moved.x = state_at(touching + 0.3e-3).x;
  stage.update_candidates(moved, moved_by(model, 0.4e-3));
  moved.step += 1;
  stage.compute(moved, 1e-5);
  EXPECT_EQ(stage.report(moved).live, 0);
  stage.update_candidates(state);  // back to the snapshot, whose contacts were apart in the meantime
  stage.compute(state, 1e-5);
  EXPECT_GT(stage.report(state).live, 0);
}

TEST(ContactRates, AContactWithAPlaneIsThatOfItsBodyAlone) {
  qdem::Model model = model_of_boxes(2);
  model.planes.push_back({"ground", {0, 0, 0}, Vector3d::UnitZ(), Vector3d::Zero(), 0.5, true, true});
  const double half = 0.02 * model.bodies[1].scale;
  const qdem::Placement aloft{Eigen::Matrix3d::Identity(), {0.5, 0, 1}},
      resting{Eigen::Matrix3d::Identity(), {0, 0, half + 1e-3}};
  qdem::State state = make_state(model, {aloft, resting});
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  const auto rates = stage.rates(state, 1e-6);
  EXPECT_EQ(rates[0].rigid.stiffness, 0.0);
  EXPECT_EQ(rates[0].particle.stiffness, 0.0);
  // Nine nodes of the bottom face, each with the whole stiffness, half as much again (contact_rates.cpp).
  const double k = 1.5 * model.contact.normal_stiffness;
  EXPECT_GT(rates[1].rigid.stiffness, 9 * k / model.body_mass(1));
  double lightest = model.node_mass(1, 0);
  for (int i = 0; i < 9; ++i) lightest = std::min(lightest, model.node_mass(1, i));  // the bottom nodes come first
  EXPECT_TRUE(near_rel(rates[1].particle.stiffness, k / lightest, 1e-14));
  EXPECT_TRUE(near_rel(rates[1].particle.damping, 2 * 0.1 * std::sqrt(k * model.body_mass(1)) / lightest, 1e-14));
}

TEST(ContactRates, OnlyWhatIsNearCounts) {
  const qdem::Model model = model_of_boxes(2);
  const double touching = 0.02 * (model.bodies[0].scale + model.bodies[1].scale) + 2e-3;
  qdem::State state = make_state(model, {qdem::Placement{}, {Eigen::Matrix3d::Identity(), {0, 0, touching + 0.2e-3}}});
  for (double& v : state.v) v = 0;
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  EXPECT_GT(stage.rates(state, 0.25e-3)[0].particle.stiffness, 0.0);
  EXPECT_EQ(stage.rates(state, 0.15e-3)[0].particle.stiffness, 0.0);
  // The same once the stage knows from its forces how far apart they are.
  stage.compute(state, 1e-6);
  EXPECT_GT(stage.rates(state, 0.25e-3)[0].particle.stiffness, 0.0);
  EXPECT_EQ(stage.rates(state, 0.15e-3)[0].particle.stiffness, 0.0);
}

TEST(ContactStage, APlaneCarriesABoxAtItsSignedDistance) {
  qdem::Model model = model_of_boxes(1);
  model.planes.push_back({"ground", {0, 0, -0.1}, Vector3d::UnitZ(), Vector3d(0, 0, 0.01), 0.5, true, true});
  const double half = 0.02 * model.bodies[0].scale;
  const double overlap = 0.2e-3, time = 0.5;  // the plane has risen by 5 mm
  qdem::State state =
      make_state(model, {{Eigen::Matrix3d::Identity(), {0, 0, -0.1 + 0.01 * time + half + 1e-3 - overlap}}});
  state.time = time;
  for (double& v : state.v) v = 0;
  for (int i = 0; i < model.shape(0).n_nodes(); ++i) qdem::State::scatter(model, state.v, 0, i, {0, 0, 0.01});
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  stage.compute(state, 1e-5);
  const auto sum = resultant(model, state, stage);
  EXPECT_TRUE(near_rel(sum.force[2], 9 * 1e6 * overlap, 1e-9));  // nine nodes of the lower face
  EXPECT_TRUE(near_abs(sum.force.head<2>().norm(), 0, 1e-12));
}

TEST(InitialOverlap, IsListedByPairs) {
  qdem::Model model = model_of_boxes(3);
  model.planes.push_back({"ground", {0, 0, -1}, Vector3d::UnitZ(), Vector3d::Zero(), 0.5, true, true});
  const double touching = 0.02 * (model.bodies[0].scale + model.bodies[1].scale) + 2e-3;
  const auto state_at = [&](double overlap) {
    return make_state(model,
                      {qdem::Placement{},
                       {Eigen::Matrix3d::Identity(), {0, 0, touching - overlap}},
                       {Eigen::Matrix3d::Identity(), {0.5, 0, -1 + 0.02 * model.bodies[2].scale + 1e-3 - overlap}}});
  };
  EXPECT_NO_THROW(refuse_initial_overlaps(model, state_at(0.1e-3), 0.01, "a test", ""));
  const auto found = initial_overlaps(model, state_at(0.5e-3), 0.01);
  ASSERT_EQ(found.size(), 2u);
  for (const auto& overlap : found) EXPECT_TRUE(near_rel(overlap.depth, 0.5e-3, 1e-9));
  try {
    refuse_initial_overlaps(model, state_at(0.5e-3), 0.01, "a test", "move them");
    FAIL() << "accepted";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::bad_data);
    const std::string text = error.what();
    for (const char* part : {"2 pairs overlap at the start by more than 1 % of the edge: ", "body 0 '' node ",
                             "body 2 '' node ", " and plane 'ground', 0.5 mm (", "a test", "move them"}) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    }
  }
}

}  // namespace
