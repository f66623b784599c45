// Contact parameters from restitution and contact time, against a direct integration of the law.
#include "qdem_solver/contact/calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/tolerance.hpp"

namespace {

struct Impact {
  double restitution, time;
};

/// A mass that runs into F = max(0, k x - c v) at 1 m/s, k = m = 1: midpoint rule.
Impact integrated(double zeta) {
  const double dt = 1e-5;
  double x = 0, v = 1, t = 0;
  const auto force = [&](double at, double speed) { return std::max(0.0, at + 2 * zeta * speed); };
  do {
    const double half_x = x + dt / 2 * v, half_v = v - dt / 2 * force(x, v);
    x += dt * half_v, v -= dt * force(half_x, half_v), t += dt;
  } while (v > 0 || force(x, v) > 0);
  return {-v, t};
}

}  // namespace

TEST(ContactCalibration, RestitutionAndTimeAreThoseOfTheLaw) {
  for (const double zeta : {0.0, 0.03, 0.2, 0.6, 0.75, 0.95}) {
    const Impact impact = integrated(zeta);
    EXPECT_TRUE(tests::near_abs(qdem::restitution_of(zeta), impact.restitution, 2e-5)) << zeta;
    const double stiffness = qdem::stiffness_for(impact.time, 1.0, zeta);
    EXPECT_TRUE(tests::near_rel(stiffness, 1.0, 5e-5)) << zeta;
  }
}

TEST(ContactCalibration, DampingRatioIsTheInverse) {
  for (const double e : {0.2, 0.5, 0.91, 1.0}) {
    EXPECT_TRUE(tests::near_abs(qdem::restitution_of(qdem::damping_ratio_for(e)), e, 1e-12)) << e;
  }
  EXPECT_TRUE(tests::near_abs(qdem::least_restitution(), std::exp(-2.0), 1e-6));
}

TEST(ContactCalibration, HertzTangentOfRock) {
  // Derivative of F = 4/3 E* sqrt(R) d^1.5 at F = 100 N, by finite difference.
  const double young = 60e9, nu = 0.25, radius = 5e-3, modulus = young / 2 / (1 - nu * nu);
  const auto indentation = [&](double load) {
    return std::pow(load / (4.0 / 3 * modulus * std::sqrt(radius)), 2.0 / 3);
  };
  const double tangent = 2e-3 / (indentation(100 + 1e-3) - indentation(100 - 1e-3));
  EXPECT_TRUE(tests::near_rel(qdem::hertz_tangent(young, nu, radius, 100), tangent, 1e-6));
}
