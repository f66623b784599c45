#include "fem_solver/contact/contact_gap.hpp"

#include <algorithm>
#include <cmath>

#include "fem_solver/model/irregularity.hpp"
#include "proto/error.hpp"

namespace fem {
namespace {

// Second derivatives of the natural spline: a tridiagonal system, by elimination.
std::vector<double> spline_curvature(const std::vector<double>& y, const std::vector<double>& z) {
  const std::size_t n = y.size();
  std::vector<double> ratio(n, 0.0), value(n, 0.0);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double before = y[k] - y[k - 1], after = y[k + 1] - y[k];
    const double right = 6 * ((z[k + 1] - z[k]) / after - (z[k] - z[k - 1]) / before);
    const double pivot = 2 * (before + after) - before * ratio[k - 1];
    ratio[k] = after / pivot;
    value[k] = (right - before * value[k - 1]) / pivot;
  }
  for (std::size_t k = n - 1; k-- > 1;) value[k] -= ratio[k] * value[k + 1];
  return value;
}

// Where the gap between two profiles is smallest: a scan, then thirds between its neighbours.
double lowest_point(const SurfaceProfile& wheel, const SurfaceProfile& rail, double shift) {
  const double low = std::max(rail.lowest_y(), wheel.lowest_y() + shift);
  const double high = std::min(rail.highest_y(), wheel.highest_y() + shift);
  if (!(high > low))
    throw proto::Error(proto::ExitCode::bad_data, "the profiles of wheel and rail do not overlap", "contact",
                       "check the axes of the two files and the wheel's shift");
  const auto gap = [&](double y) { return wheel.height_at(y - shift) - rail.height_at(y); };
  constexpr int n = 2000;
  int best = 0;
  for (int k = 1; k <= n; ++k)
    if (gap(low + (high - low) * k / n) < gap(low + (high - low) * best / n)) best = k;
  double left = low + (high - low) * std::max(best - 1, 0) / n, right = low + (high - low) * std::min(best + 1, n) / n;
  for (int k = 0; k < 60; ++k) {
    const double inner_left = left + (right - left) / 3, inner_right = right - (right - left) / 3;
    if (gap(inner_left) < gap(inner_right))
      right = inner_right;
    else
      left = inner_left;
  }
  return (left + right) / 2;
}

}  // namespace

SurfaceProfile::SurfaceProfile(std::vector<double> y, std::vector<double> z) : y_(std::move(y)), z_(std::move(z)) {
  if (y_.size() < 3) throw proto::Error(proto::ExitCode::bad_data, "a profile needs at least three points", "contact");
  if (y_.back() - y_.front() > 1.0)
    throw proto::Error(proto::ExitCode::bad_data, "a profile is wider than a metre (in millimetres?)", "contact",
                       "give y and z in metres");
  curvature_ = spline_curvature(y_, z_);
}

SurfaceProfile::SurfaceProfile(const std::string& path) {
  Irregularity table = read_irregularity_table(path);
  *this = SurfaceProfile(std::move(table.x), std::move(table.height));
}

double SurfaceProfile::height_at(double y) const {
  const double inside = std::clamp(y, y_.front(), y_.back());
  const auto next = std::upper_bound(y_.begin() + 1, y_.end() - 1, inside);
  const std::size_t k = static_cast<std::size_t>(next - y_.begin());
  const double h = y_[k] - y_[k - 1], s = (inside - y_[k - 1]) / h, t = 1 - s;
  const double height =
      t * z_[k - 1] + s * z_[k] + h * h / 6 * ((t * t * t - t) * curvature_[k - 1] + (s * s * s - s) * curvature_[k]);
  const double slope =
      (z_[k] - z_[k - 1]) / h + h / 6 * ((1 - 3 * t * t) * curvature_[k - 1] + (3 * s * s - 1) * curvature_[k]);
  return height + slope * (y - inside);
}

ContactGap contact_gap(const ContactGeometry& geometry, const PatchGrid& grid) {
  ContactGap gap{grid.zeros()};
  std::vector<double> across(static_cast<std::size_t>(grid.n_y));
  if (geometry.profiles.empty()) {
    for (int j = 0; j < grid.n_y; ++j) across[j] = geometry.crown_curvature * grid.y(j) * grid.y(j) / 2;
  } else {
    const SurfaceProfile &wheel = geometry.profiles[0], &rail = geometry.profiles[1];
    const double shift = geometry.wheel_shift, centre = lowest_point(wheel, rail, shift);
    const double half = grid.dy * grid.n_y / 2;
    if (centre - half < std::max(rail.lowest_y(), wheel.lowest_y() + shift) ||
        centre + half > std::min(rail.highest_y(), wheel.highest_y() + shift))
      throw proto::Error(
          proto::ExitCode::bad_data,
          "the patch's grid reaches beyond the profiles (contact at y = " + std::to_string(centre) + " m)", "contact",
          "give longer profiles, a narrower grid or another wheel shift");
    const double lowest = wheel.height_at(centre - shift) - rail.height_at(centre);
    for (int j = 0; j < grid.n_y; ++j) {
      const double y = centre + grid.y(j);
      across[j] = wheel.height_at(y - shift) - rail.height_at(y) - lowest;
    }
    gap.centre_y = centre;
  }
  for (int j = 0; j < grid.n_y; ++j)
    for (int i = 0; i < grid.n_x; ++i)
      gap.height(i, j) = geometry.wheel_curvature * grid.x(i) * grid.x(i) / 2 + across[j];
  return gap;
}

}  // namespace fem
