// Where the wheel touches the rail head: smooth weights that move along the running band.
#pragma once

#include <Eigen/Core>
#include <array>

#include "fem_solver/assembly/rail_system.hpp"

namespace fem {

/// Weights of consecutive node planes (two per element) around a place; they sum to one and reproduce the place.
struct BandWeights {
  static constexpr int n_planes = 7;
  int first_plane = 0;
  std::array<double, n_planes> weights{};
};

/// A wheel's force is spread along the rail by a cubic B-spline two elements long, integrated against the elements'
/// shape functions, and evenly across the flat top of the head's middle block (Simpson's weights of its quadratic
/// edge). The weights vary smoothly with the place, so a moving wheel does not feel the elements.
class HeadBand {
 public:
  explicit HeadBand(const RailSystem& system);

  /// Throws proto::Error (config) when x is nearer than three elements to a rail end.
  BandWeights at(double x) const;

  /// Vertical unit force of a node plane on all degrees of freedom; as a row it reads the vertical displacement.
  Eigen::VectorXd station_load(int plane) const;

  /// Vertical displacement or velocity of the band at the place of `weights`.
  double read(const BandWeights& weights, const Eigen::VectorXd& field) const;

  /// load += force * weights (positive up).
  void add_load(const BandWeights& weights, double force, Eigen::VectorXd& load) const;

 private:
  double first_x_, spacing_;
  int n_dofs_;
  std::vector<std::array<int, 3>> nodes_;  // of each node plane: left, middle, right of the flat top
};

}  // namespace fem
