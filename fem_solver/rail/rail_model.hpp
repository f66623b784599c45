// What the time integration, the record and the session need of a rail, whatever it is made of.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem_solver/assembly/track_system.hpp"
#include "fem_solver/contact/running_band.hpp"

namespace fem {

/// Figures for the summary and for print.
struct RailFigures {
  SectionProperties section;
  int n_elements = 0;
  double element_length = 0.0;  ///< [m]
  double length = 0.0;          ///< [m]
};

/// The rail as points and cells to be looked at.
struct RailShape {
  std::vector<double> points;              ///< [3 n_points] reference positions [m]
  std::vector<std::int64_t> connectivity;  ///< of all cells one after the other
  int nodes_per_cell = 0;                  ///< 2: line, 8: hexahedron in VTK's order
};

/// A field on the shape that the record takes. `values`: [n][components] from displacement and velocity of all degrees
/// of freedom of the track [m, rad; m/s, rad/s].
struct RailField {
  std::string name, unit, description;
  bool per_point = true;  ///< else per cell
  std::size_t components = 1;
  std::function<std::vector<double>(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity)> values;
};

/// A rail on its supports. Immutable; not copyable, since its parts refer to each other.
class RailModel {
 public:
  RailModel() = default;
  RailModel(const RailModel&) = delete;
  RailModel& operator=(const RailModel&) = delete;
  virtual ~RailModel() = default;

  virtual const TrackSystem& track() const = 0;
  virtual const RailKinematics& kinematics() const = 0;
  virtual const RunningBand& band() const = 0;
  virtual RailFigures figures() const = 0;

  /// Flexibility that the band's weights see beyond the rail as a beam [m/N]; a wheel's contact takes it out, so that
  /// local flattening is counted once, in the Hertz spring. `flexibility`: g' K^-1 g of a load g of the track.
  using Flexibility = std::function<double(const Eigen::VectorXd& load)>;
  virtual double indentation(const Flexibility& flexibility) const = 0;

  virtual RailShape shape() const = 0;
  /// Valid as long as the model lives.
  virtual std::vector<RailField> fields() const = 0;
};

/// Builds the track of a case. Throws what check_seats() and the rail's construction throw.
using RailBuilder = std::function<std::unique_ptr<RailModel>(
    const FemSettings& settings, const std::vector<proto::RailSeat>& seats, SeatOwner owner)>;

}  // namespace fem
