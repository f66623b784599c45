// Profile files for tests.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fem_solver/model/rail_section.hpp"

namespace tests {

using Outline = std::vector<Eigen::Vector2d>;

/// Outline of a section's blocks, counter-clockwise with z up [m], its corners rounded by cutting each `rounds` times.
inline Outline rounded_outline(const fem::RailSection& section, int rounds) {
  Outline points;
  const int n = static_cast<int>(section.vertices.size()) / 2;
  // The right half runs from the foot's edge at the bottom up to the head; inner corners 0 and 1 lie on the bottom.
  for (int k = 2; k < n; ++k) points.push_back(section.vertices[k]);
  for (int k = n - 1; k >= 2; --k) points.push_back(section.vertices[n + k]);
  for (int round = 0; round < rounds; ++round) {
    Outline cut;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto &a = points[i], &b = points[(i + 1) % points.size()];
      // A tenth of an edge keeps the shape a rail.
      cut.push_back(0.9 * a + 0.1 * b), cut.push_back(0.1 * a + 0.9 * b);
    }
    points = cut;
  }
  return points;
}

/// Writes points as lateral, height with z down in millimetres, the first one repeated when `closed`. Returns the path.
inline std::string write_profile(const std::string& name, const Outline& points, bool closed = true) {
  const auto path = std::filesystem::temp_directory_path() / ("fem_" + std::to_string(::getpid()) + "_" + name);
  std::ofstream file(path);
  file.precision(12);
  file << "# y_mm, z_mm (down)\n";
  for (std::size_t i = 0; i < points.size() + (closed ? 1 : 0); ++i) {
    const auto& p = points[i % points.size()];
    file << p[0] * 1e3 << ", " << -p[1] * 1e3 << "\n";
  }
  return path;
}

}  // namespace tests
