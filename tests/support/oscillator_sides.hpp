// The split oscillator in one process: two model participants for the coupling schemes, and its closed form.
//
// Rail mass on a spring, pad, sleeper mass on a spring (coupling test problem T2): mA = 1 kg, kA = 1 N/m, mB = 0.5 kg,
// kB = 4 N/m, pad 10 N/m and 0.2 N s/m; start u = 1 m, x = -0.5 m, x' = 0.3 m/s.
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/MatrixFunctions>

#include "coupler/advisor/lumped_track.hpp"

namespace tests {

using RailModel = coupler::LumpedRail;
using SleeperModel = coupler::LumpedSleeper;

struct Oscillator : coupler::LumpedTrack {
  Oscillator() {
    rail_mass = 1.0, rail_stiffness = 1.0, sleeper_mass = 0.5, sleeper_stiffness = 4.0;
    pad = {10.0, 0.2, 0.0, false};
    u = 1.0, v = 0.0, x = -0.5, y = 0.3;
  }
};

/// z' = A z of z = (u, u', x, x'), without load and cut-off.
inline Eigen::Matrix4d system_matrix(const coupler::LumpedTrack& o) {
  const double k = o.pad.stiffness, c = o.pad.damping;
  Eigen::Matrix4d a;
  a << 0, 1, 0, 0,                                                                                //
      -(o.rail_stiffness + k) / o.rail_mass, -c / o.rail_mass, k / o.rail_mass, c / o.rail_mass,  //
      0, 0, 0, 1,                                                                                 //
      k / o.sleeper_mass, c / o.sleeper_mass, -(o.sleeper_stiffness + k) / o.sleeper_mass,
      -(o.sleeper_damping + c) / o.sleeper_mass;
  return a;
}

/// (u, u', x, x') at `time` by the matrix exponential.
inline Eigen::Vector4d exact_state(const coupler::LumpedTrack& o, double time) {
  return (system_matrix(o) * time).exp() * Eigen::Vector4d(o.u, o.v, o.x, o.y);
}

}  // namespace tests
