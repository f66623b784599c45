#include "fem_solver/model/rail_section.hpp"

#include <Eigen/LU>
#include <cmath>

#include "proto/error.hpp"

namespace fem {
namespace {

// 60E1 of EN 13674-1 (UIC60), right half, (y, z) in mm. The corners follow the standard's outline: height 172, foot
// 150, head 72 at 14.1 below the top with sides 1:20, web 16.5 (R508 sides), head and foot slopes 1:2.75 from 51
// and 31.5 at the centre line, foot edge 1:14 from 11.5, crown R300 - R80 - R13, head fillet R7. The foot fillet (R7,
// R35 and R120 in the standard) enters as one arc of 20 mm, which gives the tabulated area within 0.2 %. The outer head
// corner and the foot edge stand for their rounded arcs: they are placed so that the polygon keeps area and second
// moments.
constexpr double half_60e1[][2] = {
    {21.0, 0.0}, {48.0, 0.0}, {75.0, 0.0},  {75.0, 10.8},   {48.0, 13.9},  {21.0, 23.9},  {12.5, 31.6},
    {9.3, 44.0}, {8.2, 80.0}, {9.5, 118.0}, {12.5, 125.15}, {37.0, 135.0}, {35.4, 166.6}, {12.5, 171.72},
};
constexpr int n_half = sizeof(half_60e1) / sizeof(half_60e1[0]);

RailSection section_60e1() {
  RailSection s;
  for (const double side : {1.0, -1.0})
    for (const auto& p : half_60e1) s.vertices.emplace_back(side * p[0] * 1e-3, p[1] * 1e-3);
  const auto left = [](int right) { return right + n_half; };
  const auto across = [&](int low, int high) { s.quads.push_back({left(low), low, left(high), high}); };
  const auto both = [&](int a, int b, int c, int d) {
    s.quads.push_back({a, b, c, d});
    s.quads.push_back({left(b), left(a), left(d), left(c)});
  };
  across(0, 5);
  both(0, 1, 5, 4);
  both(1, 2, 4, 3);
  for (int row = 5; row < 10; ++row) across(row, row + 1);
  across(10, 13);
  both(10, 11, 13, 12);
  s.head_half_width = half_60e1[13][0] * 1e-3;
  s.head_height = half_60e1[13][1] * 1e-3;
  s.foot_half_width = half_60e1[2][0] * 1e-3;
  // UIC60 of the rail database of rolland (Mantel, public code).
  s.torsion_constant = 2.212e-6, s.shear_vertical = 0.393, s.shear_lateral = 0.538;
  return s;
}

Eigen::Vector4d bilinear(const Eigen::Vector2d& l) {
  return {(1 - l[0]) * (1 - l[1]), l[0] * (1 - l[1]), (1 - l[0]) * l[1], l[0] * l[1]};
}

}  // namespace

RailSection::Place RailSection::locate(const Eigen::Vector2d& point) const {
  for (std::size_t q = 0; q < quads.size(); ++q) {
    Eigen::Matrix<double, 2, 4> corners;
    for (int k = 0; k < 4; ++k) corners.col(k) = vertices[quads[q][k]];
    Eigen::Vector2d local(0.5, 0.5);
    for (int iteration = 0; iteration < 20; ++iteration) {
      Eigen::Matrix<double, 4, 2> slope;
      slope << -(1 - local[1]), -(1 - local[0]), 1 - local[1], -local[0], -local[1], 1 - local[0], local[1], local[0];
      const Eigen::Vector2d step = (corners * slope).inverse() * (point - corners * bilinear(local));
      local += step;
      if (step.norm() < 1e-14 || local.norm() > 1e3) break;
    }
    const bool inside = local.minCoeff() > -1e-9 && local.maxCoeff() < 1 + 1e-9;
    if (inside && (corners * bilinear(local) - point).norm() < 1e-9) return {static_cast<int>(q), local};
  }
  throw proto::Error(proto::ExitCode::bad_data,
                     "the point y = " + std::to_string(point[0]) + " m, z = " + std::to_string(point[1]) +
                         " m lies outside the rail's cross-section",
                     "[[rail_seat]] and [fem] profile",
                     "keep the pad within the foot and the rail centred on the seat");
}

SectionProperties RailSection::properties() const {
  double area = 0, first = 0, second_z = 0, second_y = 0;
  for (const auto& quad : quads) {
    const int ring[4] = {quad[0], quad[1], quad[3], quad[2]};
    for (int k = 0; k < 4; ++k) {
      const auto &a = vertices[ring[k]], &b = vertices[ring[(k + 1) % 4]];
      const double cross = a[0] * b[1] - a[1] * b[0];
      area += cross / 2;
      first += cross * (a[1] + b[1]) / 6;
      second_z += cross * (a[1] * a[1] + a[1] * b[1] + b[1] * b[1]) / 12;
      second_y += cross * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) / 12;
    }
  }
  return {area, first / area, second_z - first * first / area, second_y};
}

std::vector<std::string> rail_section_names() {
  return {"60E1"};
}

RailSection rail_section(const std::string& name) {
  if (name == "60E1") return section_60e1();
  const std::string nearest = proto::nearest_name(name, rail_section_names());
  throw proto::Error(proto::ExitCode::config, "unknown rail profile '" + name + "'", "fem.profile",
                     nearest.empty() ? "choose 60E1" : "did you mean '" + nearest + "'?");
}

}  // namespace fem
