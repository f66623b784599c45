// Heaps of stones: dumped on a plane, and how steep they are.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"

namespace tests {

/// Mean position of a body's particles, weighted with their masses.
inline Eigen::Vector3d centre_of(const qdem::Model& model, const qdem::State& state, int body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < model.shape(body).n_nodes(); ++i) {
    sum += model.node_mass(body, i) / model.body_mass(body) * state.position(model, body, i);
  }
  return sum;
}

/// Slope [degrees] of the cone on the plane z = 0 that has the heap's mean height H/4 and mean distance R/2 from its
/// axis. Stones that touch no other are not part of the heap.
inline double heap_angle(const qdem::Model& model, const qdem::State& state, const qdem::ContactStage& contacts) {
  std::vector<char> touching(model.bodies.size(), 0);
  contacts.for_each_live(state, [&](const qdem::ContactKey& key, int, double) {
    if (!key.is_plane()) touching[key.body_a] = touching[key.body_b] = 1;
  });
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double distance = 0.0;
  int n = 0;
  for (int b = 0; b < static_cast<int>(touching.size()); ++b) {
    if (touching[b]) mean += centre_of(model, state, b), ++n;
  }
  mean /= n;
  for (int b = 0; b < static_cast<int>(touching.size()); ++b) {
    if (touching[b]) distance += (centre_of(model, state, b) - mean).head<2>().norm() / n;
  }
  return std::atan2(4 * mean[2], 2 * distance) * 180 / M_PI;
}

/// Bodies on a lattice of `across` x `across` columns over z = 0, `pitch` [m] apart, turned at random.
inline std::vector<qdem::Placement> loose_column(int n, int across, double pitch, std::mt19937_64& random) {
  const auto uniform = [&random] { return 2 * static_cast<double>(random() >> 11) * 0x1p-53 - 1; };
  std::vector<qdem::Placement> places(n);
  for (int i = 0; i < n; ++i) {
    Eigen::Quaterniond turn(uniform(), uniform(), uniform(), uniform());
    places[i].rotation = turn.normalized().toRotationMatrix();
    const Eigen::Vector3d cell(i % across - 0.5 * (across - 1), i / across % across - 0.5 * (across - 1),
                               i / (across * across) + 0.6);
    places[i].translation = pitch * cell;
  }
  return places;
}

/// Lets go of everything and waits until the root mean square speed is below `speed` [m/s], `longest` [s] at most.
inline void dump(const qdem::Model& model, qdem::State& state, qdem::Engine& engine, double speed, double longest) {
  const qdem::StepBound bound(model);
  double mass = 0.0;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) mass += model.body_mass(b);
  constexpr int steps_per_look = 20;
  engine.prepare(state);
  double dt = 0.0;
  while (state.time < longest) {
    const double moved = 4 * engine.largest_speed(state) * steps_per_look * dt;
    dt = 0.7 * bound.at(state, engine.contacts(), qdem::near_gap(model.contact) + moved);
    engine.advance(state, dt, steps_per_look);
    if (state.time > 0.3 && engine.kinetic_energy(state) < 0.5 * mass * speed * speed) return;
  }
}

}  // namespace tests
