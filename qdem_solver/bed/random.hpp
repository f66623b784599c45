// Random numbers that are the same on every machine: std::mt19937_64 and own transforms of it.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>

namespace qdem::bed {

/// A stream of its own for every purpose, so that more draws for one do not shift another.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(seed * 0x9E3779B97F4A7C15u + stream) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, n).
  std::size_t index(std::size_t n) { return static_cast<std::size_t>(engine_() % n); }

  Eigen::Vector3d direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 2 * M_PI), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  /// Uniform over all rotations: a unit quaternion by Shoemake's three draws.
  Eigen::Matrix3d rotation() {
    const double u = uniform(), a = uniform(0, 2 * M_PI), b = uniform(0, 2 * M_PI);
    const double p = std::sqrt(1 - u), q = std::sqrt(u);
    return Eigen::Quaterniond(q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b)).toRotationMatrix();
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace qdem::bed
