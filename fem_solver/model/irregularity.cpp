#include "fem_solver/model/irregularity.hpp"

#include <algorithm>
#include <cmath>

#include "fem_solver/model/columns.hpp"

namespace fem {
namespace {

constexpr double pi = 3.14159265358979323846;

double dipped_joint(const Irregularity& r, double x) {
  const double inside = 1 - 2 * std::abs(x - r.position) / r.length;
  return inside > 0 ? -r.depth * inside * inside : 0.0;
}

double corrugation(const Irregularity& r, double x) {
  const double s = (x - r.position) / r.length;
  if (s <= 0) return 0.0;
  const double fade = s < 1 ? s * s * (3 - 2 * s) : 1.0;
  return r.depth * fade * std::sin(2 * pi * s);
}

// Distance from the middle of the flat that is nearest to the rail.
double from_flat(const Irregularity& r, double x) {
  return std::remainder(x - r.position, 2 * pi * r.radius);
}

double fresh_flat(const Irregularity& r, double x) {
  const double from_edge = r.length / 2 - std::abs(from_flat(r, x));
  return from_edge > 0 ? std::sqrt(r.radius * r.radius - from_edge * from_edge) - r.radius : 0.0;
}

double rounded_flat(const Irregularity& r, double x) {
  const double s = from_flat(r, x);
  return std::abs(s) < r.length / 2 ? -r.depth / 2 * (1 + std::cos(2 * pi * s / r.length)) : 0.0;
}

double interpolated(const Irregularity& r, double x) {
  if (x <= r.x.front()) return r.height.front();
  if (x >= r.x.back()) return r.height.back();
  const auto i = std::upper_bound(r.x.begin(), r.x.end(), x) - r.x.begin();
  const double s = (x - r.x[i - 1]) / (r.x[i] - r.x[i - 1]);
  return (1 - s) * r.height[i - 1] + s * r.height[i];
}

}  // namespace

double Irregularity::height_at(double position_along_track) const {
  switch (kind) {
    case IrregularityKind::none:
      return 0.0;
    case IrregularityKind::dipped_joint:
      return dipped_joint(*this, position_along_track);
    case IrregularityKind::corrugation:
      return corrugation(*this, position_along_track);
    case IrregularityKind::table:
      return interpolated(*this, position_along_track);
    case IrregularityKind::fresh_flat:
      return fresh_flat(*this, position_along_track);
    case IrregularityKind::rounded_flat:
      return rounded_flat(*this, position_along_track);
  }
  return 0.0;
}

Irregularity read_irregularity_table(const std::string& path) {
  const TwoColumns file(path, "irregularity table", "x_m, height_m");
  file.require_ascending();
  Irregularity table;
  table.kind = IrregularityKind::table;
  for (const auto& row : file.rows()) table.x.push_back(row.first), table.height.push_back(row.second);
  return table;
}

}  // namespace fem
