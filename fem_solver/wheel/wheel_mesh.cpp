#include "fem_solver/wheel/wheel_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "proto/error.hpp"

namespace fem {
namespace {

constexpr double pi = 3.14159265358979323846;

// Depths below the tread where the rim's rows of blocks end, as shares of the rim's thickness: thin under the contact.
constexpr double rim_rows[] = {0.0, 0.2, 0.5, 1.0};
constexpr int n_rim_rows = sizeof(rim_rows) / sizeof(rim_rows[0]);

// Integrals of r and r^3 over a quadrilateral (by two triangles, rule of degree three), times a full turn.
double turned(const Meridian& m, int power) {
  double sum = 0.0;
  const auto triangle = [&](int a, int b, int c) {
    const Eigen::Vector2d &p = m.vertices[a], &q = m.vertices[b], &s = m.vertices[c];
    const double area = std::abs((q - p)[0] * (s - p)[1] - (q - p)[1] * (s - p)[0]) / 2;
    const auto value = [&](double u, double v, double w) { return std::pow(u * p[1] + v * q[1] + w * s[1], power); };
    constexpr double centre = -27.0 / 48, corner = 25.0 / 48;
    sum += area * (centre * value(1.0 / 3, 1.0 / 3, 1.0 / 3) +
                   corner * (value(0.6, 0.2, 0.2) + value(0.2, 0.6, 0.2) + value(0.2, 0.2, 0.6)));
  };
  for (const auto& q : m.quads) triangle(q[0], q[1], q[2]), triangle(q[1], q[3], q[2]);
  return 2 * pi * sum;
}

}  // namespace

double Meridian::volume() const {
  return turned(*this, 1);
}
double Meridian::second_moment() const {
  return turned(*this, 3);
}

Meridian wheel_meridian(const SolidWheelSettings& wheel, double radius) {
  const auto refuse = [](const std::string& problem) {
    throw proto::Error(proto::ExitCode::bad_data, problem, "[wheel.solid] web_file, [wheel] radius_m",
                       "give rows from the bore to the rim's inner side");
  };
  const double rim_radius = wheel.web_radius.back(), half = wheel.web_thickness.back() / 2;
  if (rim_radius > radius - 0.02) refuse("the web reaches to within 20 mm of the tread");
  if (half > 0.035 || half < 0.005) refuse("the web is thinner than 10 mm or thicker than 70 mm at the rim");
  Meridian m;
  m.bore_radius = wheel.web_radius.front();
  m.contact_quad = 3;  // of the first row: between the columns over the web

  // Rim: columns from the flange's back to the outer face, rows from the tread inwards.
  const std::vector<double> columns{tread_back, -0.055, -0.040, -half, half, tread_front};
  const int n_columns = static_cast<int>(columns.size());
  for (const double share : rim_rows)
    for (const double y : columns) {
      const double outer = radius + tread_height(wheel.tread, y);
      m.vertices.emplace_back(y, outer + share * (rim_radius - outer));
    }
  for (int row = 0; row + 1 < n_rim_rows; ++row)
    for (int c = 0; c + 1 < n_columns; ++c) {
      const int corner = row * n_columns + c;
      m.quads.push_back({corner, corner + 1, corner + n_columns, corner + n_columns + 1});
    }
  // Web and hub, from the rim inwards.
  int outer = (n_rim_rows - 1) * n_columns + 3;
  for (std::size_t layer = wheel.web_radius.size() - 1; layer-- > 0;) {
    const int inner = static_cast<int>(m.vertices.size());
    for (const double side : {-0.5, 0.5})
      m.vertices.emplace_back(side * wheel.web_thickness[layer], wheel.web_radius[layer]);
    m.quads.push_back({outer, outer + 1, inner, inner + 1});
    outer = inner;
  }
  return m;
}

std::vector<double> wheel_angles(double finest, double coarsest) {
  // Half a turn in growing steps, scaled to close it.
  std::vector<double> half{0.0};
  for (double step = finest; half.back() < pi; step = std::min(1.3 * step, coarsest))
    half.push_back(half.back() + step);
  // The first two steps carry the contact patch and stay; the others are stretched.
  const double kept = half[2], scale = (pi - kept) / (half.back() - kept);
  for (std::size_t i = 3; i < half.size(); ++i) half[i] = kept + scale * (half[i] - kept);
  std::vector<double> angles;
  for (std::size_t i = half.size() - 1; i-- > 1;) angles.push_back(-half[i]);
  angles.insert(angles.end(), half.begin(), half.end());
  return angles;
}

HexahedronMesh revolved(const Meridian& meridian, const std::vector<double>& angles) {
  const int n_vertices = static_cast<int>(meridian.vertices.size()), n_angles = static_cast<int>(angles.size());
  HexahedronMesh mesh;
  for (const double angle : angles)
    for (const auto& v : meridian.vertices)
      mesh.points.emplace_back(v[1] * std::sin(angle), v[0], -v[1] * std::cos(angle));
  // At the contact point the angle runs along x, the meridian's first direction along y, its second upwards.
  for (int a = 0; a < n_angles; ++a)
    for (const auto& quad : meridian.quads) {
      std::array<int, 8> cell;
      for (int k = 0; k < 8; ++k) cell[k] = (a + (k & 1)) % n_angles * n_vertices + quad[k >> 1];
      mesh.cells.push_back(cell);
    }
  return mesh;
}

}  // namespace fem
