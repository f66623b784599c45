// Where the wheel touches the rail: weights that move along the running band.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fem {

/// A place on the running band as weights of consecutive stations.
struct BandWeights {
  int first_station = 0;
  std::vector<double> weights;
  double missing_flexibility = 0.0;  ///< of this place under a force on it, which the stations cannot show [m/N]
};

/// A station is a unit vertical force on some degrees of freedom of the track; as a row it reads a displacement. A
/// wheel's force at a place is spread over the stations around it, and the place's displacement is read with the same
/// weights.
class RunningBand {
 public:
  virtual ~RunningBand() = default;

  /// Throws proto::Error (config) when x is too near to a rail end.
  virtual BandWeights at(double x) const = 0;

  /// Unit force of a station on all degrees of freedom.
  Eigen::VectorXd station_load(int station) const;

  /// Vertical displacement or velocity of the band at the place of `weights`.
  double read(const BandWeights& weights, const Eigen::VectorXd& field) const;

  /// load += force * weights (positive up).
  void add_load(const BandWeights& weights, double force, Eigen::VectorXd& load) const;

 protected:
  struct Share {
    int dof;
    double weight;
  };
  /// `stations`: in the order of the rail; `n_dofs`: of the track.
  RunningBand(std::vector<std::vector<Share>> stations, int n_dofs) : stations_(std::move(stations)), n_dofs_(n_dofs) {}

  int n_stations() const { return static_cast<int>(stations_.size()); }
  [[noreturn]] static void refuse_end(double x);

 private:
  std::vector<std::vector<Share>> stations_;
  int n_dofs_;
};

}  // namespace fem
