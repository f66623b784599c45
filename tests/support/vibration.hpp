// Free vibration of one body through the engine, seen as the part of it that moves like a given shape.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "qdem_solver/engine/engine.hpp"
#include "qdem_solver/engine/stability.hpp"

namespace tests {

/// A displacement or velocity of every node of one body.
using MotionShape = std::vector<Eigen::Vector3d>;

/// Equidistant samples, the first at t = 0.
struct Signal {
  std::vector<double> values;
  double interval = 0.0;  ///< [s]
};

/// Frequency [Hz] from the upward zero crossings of a signal.
inline double frequency(const Signal& signal) {
  const auto& values = signal.values;
  std::vector<double> crossings;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i - 1] >= 0 || values[i] < 0) continue;
    crossings.push_back((static_cast<double>(i) - values[i] / (values[i] - values[i - 1])) * signal.interval);
  }
  return (static_cast<double>(crossings.size()) - 1) / (crossings.back() - crossings.front());
}

/// The body leaves its reference position at minus `shape` in small; the signal is the mass-weighted projection of its
/// velocity on `shape`, so that it crosses zero upward after a quarter of a period.
inline Signal vibration(const qdem::Model& model, const MotionShape& shape, double duration, double step_share = 0.5) {
  constexpr double small = 1e-3;  // of a shape of order one [m/s]: strains of 1e-6 and below
  qdem::State state = qdem::make_state(model, {{}});
  for (std::size_t i = 0; i < shape.size(); ++i) {
    qdem::State::scatter(model, state.v, 0, static_cast<int>(i), -small * shape[i]);
  }
  qdem::Engine engine(model, {1});
  engine.prepare(state);
  const auto rates = qdem::template_rates(model.templates[0], model.materials[0]);
  Signal signal{{}, step_share * qdem::largest_stable_step(rates)};
  while (state.time < duration) {
    double amplitude = 0;
    for (int i = 0; i < model.shape(0).n_nodes(); ++i) {
      amplitude += model.node_mass(0, i) * shape[i].dot(state.velocity(model, 0, i));
    }
    signal.values.push_back(amplitude);
    engine.advance(state, signal.interval, 1);
  }
  return signal;
}

}  // namespace tests
