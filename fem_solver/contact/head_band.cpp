#include "fem_solver/contact/head_band.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fem {
namespace {
constexpr int n_spread = 7;  // node planes under the spline
constexpr std::array<double, 3> simpson{1.0 / 6, 4.0 / 6, 1.0 / 6};

// Cubic B-spline of unit knot distance and unit integral, support [-2, 2].
double cubic_spline(double t) {
  const double a = std::abs(t);
  if (a >= 2) return 0.0;
  return a >= 1 ? (2 - a) * (2 - a) * (2 - a) / 6 : 2.0 / 3 - a * a + a * a * a / 2;
}

// Quadratic shape function of a node plane at t, in units of the planes' distance; even planes are element boundaries.
double shape(int plane, double t) {
  const int element = static_cast<int>(std::floor(t / 2));
  const int local = plane - 2 * element;
  const double s = t - 2 * element;  // in [0, 2)
  switch (local) {
    case 0:
      return (s - 1) * (s - 2) / 2;
    case 1:
      return s * (2 - s);
    case 2:
      return s * (s - 1) / 2;
    default:
      return 0.0;
  }
}
}  // namespace

std::vector<std::vector<RunningBand::Share>> HeadBand::node_planes(const RailSystem& system) {
  const auto& mesh = *system.mesh;
  const double length = system.fine_end - system.fine_begin;
  const int n_planes = 2 * static_cast<int>(std::lround(length / system.element_length)) + 1;
  std::vector<std::vector<Share>> stations;
  for (int plane = 0; plane < n_planes; ++plane) {
    const double x = std::min(system.fine_begin + plane * system.element_length / 2, system.fine_end);
    std::vector<Share> shares;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d point(x, mesh.lateral() + (k - 1) * mesh.section().head_half_width,
                                  mesh.section().head_height);
      const NodeWeights row = mesh.interpolation(point);
      const int node = row.nodes[std::max_element(row.weights.begin(), row.weights.end()) - row.weights.begin()];
      shares.push_back({3 * node + 2, simpson[k]});
    }
    stations.push_back(std::move(shares));
  }
  return stations;
}

HeadBand::HeadBand(const RailSystem& system)
    : RunningBand(node_planes(system), system.n_dofs()),
      first_x_(system.fine_begin),
      spacing_(system.element_length / 2) {}

BandWeights HeadBand::at(double x) const {
  const double centre = (x - first_x_) / spacing_;
  const int element = static_cast<int>(std::floor(centre / 2));
  BandWeights result{2 * element - 2, std::vector<double>(n_spread)};
  // The spline reaches one element to each side of its centre: the elements before, around and after it.
  if (result.first_station < 2 || result.first_station + n_spread + 2 > n_stations()) refuse_end(x);
  // Between the spline's knots and the element boundaries the integrand is of degree five: three Gauss points are
  // exact.
  constexpr double point[3] = {-0.774596669241483377, 0.0, 0.774596669241483377};
  constexpr double weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  std::array<double, 9> ends;
  for (int k = 0; k <= 4; ++k) ends[k] = centre - 2 + k;
  for (int k = 0; k < 4; ++k) ends[5 + k] = std::clamp(2.0 * (element - 1 + k), centre - 2, centre + 2);
  std::sort(ends.begin(), ends.end());
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    const double half = (ends[k + 1] - ends[k]) / 2, middle = (ends[k + 1] + ends[k]) / 2;
    for (int g = 0; g < 3 && half > 0; ++g) {
      const double t = middle + half * point[g], value = half * weight[g] * cubic_spline(t - centre);
      for (int j = 0; j < n_spread; ++j) result.weights[j] += value * shape(result.first_station + j, t);
    }
  }
  return result;
}

}  // namespace fem
