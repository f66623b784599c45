// Small scenes of touching bodies for the contact tests.
#pragma once

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <random>

#include "qdem_solver/contact/contact_stage.hpp"

namespace tests {

/// A box of edge lengths `size` centred at the origin, n cells along each edge, six tetrahedra a cell.
inline qdem::Template box_template(const Eigen::Vector3d& size, int n) {
  std::vector<Eigen::Vector3d> nodes;
  const auto id = [n](int i, int j, int k) { return (k * (n + 1) + j) * (n + 1) + i; };
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        nodes.push_back(size.cwiseProduct(Eigen::Vector3d(i, j, k) / n - Eigen::Vector3d::Constant(0.5)));
      }
    }
  }
  constexpr int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
  std::vector<std::array<int, 4>> tets;
  for (int cell = 0; cell < n * n * n; ++cell) {
    for (int p = 0; p < 6; ++p) {
      std::array<int, 3> at{cell % n, cell / n % n, cell / n / n};
      std::array<int, 4> tet;
      tet[0] = id(at[0], at[1], at[2]);
      for (int c = 0; c < 3; ++c) ++at[order[p][c]], tet[c + 1] = id(at[0], at[1], at[2]);
      if (p >= 3) std::swap(tet[2], tet[3]);  // odd permutations are left-handed
      tets.push_back(tet);
    }
  }
  return qdem::make_template("box", nodes, tets);
}

inline qdem::Model model_of_boxes(int n_bodies, double friction = 0.5, double damping_ratio = 0.1) {
  qdem::Model model;
  model.materials.push_back({"rock", 6e10, 0.25, 2700, 0, 0});
  model.templates.push_back(box_template({0.06, 0.05, 0.04}, 2));
  for (int b = 0; b < n_bodies; ++b) {
    qdem::Body body;
    body.scale = 0.8 + 0.05 * (b % 7);
    model.bodies.push_back(body);
  }
  model.contact.normal_stiffness = 1e6;
  model.contact.friction = friction;
  model.contact.damping_ratio = damping_ratio;
  model.contact.rounding = 1e-3;
  make_batches(model);
  return model;
}

inline double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

inline Eigen::Vector3d in_cube(std::mt19937_64& random, double half) {
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return half * Eigen::Vector3d(2 * x - 1, 2 * y - 1, 2 * z - 1);
}

inline Eigen::Matrix3d turn(std::mt19937_64& random) {
  Eigen::Vector3d axis = in_cube(random, 1.0);
  while (axis.norm() < 0.1) axis = in_cube(random, 1.0);
  return Eigen::AngleAxisd(2 * M_PI * uniform(random), axis.normalized()).toRotationMatrix();
}

/// Bodies strewn in a cube of the given half edge, turned at random, with random particle velocities.
inline qdem::State strewn(const qdem::Model& model, std::mt19937_64& random, double half_edge, double speed) {
  std::vector<qdem::Placement> placements;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    placements.push_back({turn(random), in_cube(random, half_edge)});
  }
  qdem::State state = make_state(model, placements);
  for (double& v : state.v) v = speed * (2 * uniform(random) - 1);
  return state;
}

/// Sum of forces, sum of moments about the origin, and sum of |force| over all bodies' nodes.
struct Resultant {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  double size = 0.0;
};

inline Resultant resultant(const qdem::Model& model, const qdem::State& state, const qdem::ContactStage& stage) {
  std::vector<double> force(state.x.size(), 0.0);
  Resultant sum;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    stage.gather(b, force);
    for (int i = 0; i < model.shape(b).n_nodes(); ++i) {
      const Eigen::Vector3d f = qdem::State::gather(model, force, b, i);
      sum.force += f;
      sum.moment += state.position(model, b, i).cross(f);
      sum.size += f.norm();
    }
  }
  return sum;
}

/// Contacts of a body at the origin and another one shifted by so much, which must give finite forces without resultant
/// moment; the resultant.
inline Resultant finite_resultant(const qdem::Model& pair, const Eigen::Vector3d& shift) {
  qdem::State state = make_state(pair, {qdem::Placement{}, {Eigen::Matrix3d::Identity(), shift}});
  qdem::ContactStage stage(pair);
  stage.update_candidates(state);
  stage.compute(state, 1e-5);
  const auto sum = resultant(pair, state, stage);
  EXPECT_TRUE(std::isfinite(sum.size));
  EXPECT_LT(sum.moment.norm(), 1e-12 * std::max(1.0, sum.size));
  for (const auto& rates : stage.rates(state, 1e-6)) EXPECT_TRUE(std::isfinite(rates.particle.stiffness));
  return sum;
}

struct ComputedContacts {
  std::vector<double> forces;  ///< laid out like State::x [N]
  std::vector<qdem::ContactKey> keys;
};

/// Of bodies strewn in a cube of the given half edge, after three steps, by so many threads.
inline ComputedContacts contacts_by(int n_threads, const qdem::Model& model, double half_edge) {
  omp_set_num_threads(n_threads);
  std::mt19937_64 random(6);
  qdem::State state = strewn(model, random, half_edge, 1.0);
  qdem::ContactStage stage(model);
  stage.update_candidates(state);
  for (int i = 0; i < 3; ++i) stage.compute(state, 1e-5);
  ComputedContacts result{std::vector<double>(state.x.size(), 0.0), state.contact.keys};
  for (std::size_t b = 0; b < model.bodies.size(); ++b) stage.gather(static_cast<int>(b), result.forces);
  return result;
}

inline void expect_same_bytes_by_threads(const qdem::Model& model, double half_edge) {
  const auto one = contacts_by(1, model, half_edge), two = contacts_by(2, model, half_edge);
  EXPECT_TRUE(one.keys == two.keys);
  EXPECT_EQ(std::memcmp(one.forces.data(), two.forces.data(), one.forces.size() * sizeof(double)), 0);
}

}  // namespace tests
