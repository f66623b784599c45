// A heap of bodies that falls on the ground: lanes and single bodies, contact of all kinds.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>

#include "tests/support/box_mesh.hpp"

namespace tests {

/// Twenty cubes of two sizes dropped in a heap on a rough ground plane, and a larger box of one lane among them.
inline qdem::Model heap(qdem::Interaction interaction = qdem::Interaction::quadruple) {
  auto model = free_bodies(box_template({2, 2, 2}, {0.04, 0.04, 0.04}), rock(), 20);
  model.materials[0].young = 1e8;
  model.materials[0] = with_retardation(model.materials[0], 1e-6);
  model.materials[0].interaction = interaction;
  model.templates.push_back(box_template({12, 4, 3}, {0.3, 0.1, 0.08}));
  qdem::Body slab;
  slab.kind = qdem::BodyKind::sleeper, slab.name = "slab", slab.template_id = 1;
  model.bodies.push_back(slab);
  for (int i = 0; i < 20; ++i)
    model.bodies[i].scale = 1.0 + 0.2 * (i % 3), model.bodies[i].kind = qdem::BodyKind::stone;
  model.gravity = {0.5, 0, -9.81};
  model.contact = {1e5, 0.8, 0.2, 0.5, 1e-3};
  model.planes.push_back({"ground", {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0.5});
  qdem::make_batches(model);
  return model;
}

/// The same with contact spheres that roll with resistance.
inline qdem::Model heap_of_spheres() {
  auto model = heap();
  model.contact.shape = qdem::ContactShape::sphere, model.contact.radii = qdem::SphereRadii::by_edge;
  model.contact.rounding = 12e-3, model.contact.rolling_friction = 0.1;
  model.contact.damping_ratio = 0.7, model.gravity *= 10;  // they stay together
  return model;
}

inline qdem::State heap_state(const qdem::Model& model) {
  std::vector<qdem::Placement> places(21);
  for (int i = 0; i < 20; ++i) {
    places[i].rotation = Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d(1, 0.1 * i, -0.5).normalized()).toRotationMatrix();
    const Eigen::Vector3d centre(0.1 * (i % 5), 0.1 * (i / 10), 0.052 + 0.1 * ((i / 5) % 2));
    places[i].translation = centre - places[i].rotation * Eigen::Vector3d::Constant(0.02 * model.bodies[i].scale);
  }
  places[20].translation = Eigen::Vector3d(0.05, 0, 0.21);
  qdem::State state = qdem::make_state(model, places);
  for (double& v : state.v) v = 0;
  for (int body = 0; body < 21; ++body) {
    for (int node = 0; node < model.shape(body).n_nodes(); ++node) {
      qdem::State::scatter(model, state.v, body, node, {0, 0, -2.0});
    }
  }
  return state;
}

inline bool same_bytes(const std::vector<double>& p, const std::vector<double>& q) {
  return p.size() == q.size() && std::memcmp(p.data(), q.data(), p.size() * sizeof(double)) == 0;
}

inline void expect_same_bytes(const qdem::State& p, const qdem::State& q) {
  EXPECT_TRUE(same_bytes(p.x, q.x));
  EXPECT_TRUE(same_bytes(p.v, q.v));
  EXPECT_TRUE(same_bytes(p.a, q.a));
  EXPECT_TRUE(p.contact.keys == q.contact.keys);
  EXPECT_TRUE(p.contact.slip == q.contact.slip);
  EXPECT_TRUE(p.contact.roll == q.contact.roll);
  EXPECT_EQ(p.ledger.contact_dashpots, q.ledger.contact_dashpots);
  EXPECT_EQ(p.ledger.friction, q.ledger.friction);
  EXPECT_EQ(p.ledger.viscous, q.ledger.viscous);
}

inline constexpr double heap_step = 2e-5;  ///< stable for the heap [s]

}  // namespace tests
