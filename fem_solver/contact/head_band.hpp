// The running band of the solid rail.
#pragma once

#include "fem_solver/assembly/rail_system.hpp"
#include "fem_solver/contact/running_band.hpp"

namespace fem {

/// Stations are node planes (two per element) of the refined part. A wheel's force is spread along the rail by a cubic
/// B-spline two elements long, integrated against the elements' shape functions, and evenly across the flat top of the
/// head's middle block (Simpson's weights of its quadratic edge). The weights vary smoothly with the place, so a moving
/// wheel does not feel the elements; they sum to one and reproduce the place.
class HeadBand : public RunningBand {
 public:
  explicit HeadBand(const RailSystem& system);

  BandWeights at(double x) const override;

 private:
  static std::vector<std::vector<Share>> node_planes(const RailSystem& system);

  double first_x_, spacing_;
};

}  // namespace fem
