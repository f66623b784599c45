// The rail foot on the pads while the bed runs alone.
#pragma once

#include <cstdint>
#include <vector>

#include "qdem_solver/participant/load_settings.hpp"
#include "qdem_solver/participant/track_bed.hpp"

namespace qdem {

/// Without a load on the pads the rail is lifted. With forces it presses every cell with its share (by stiffness) of
/// their sum: it follows the sleeper, deeper by the spring's compression. With a displacement it goes down by that, and
/// keeps its place along the other axes.
class RailFoot {
 public:
  RailFoot(TrackBed& bed, const std::vector<LoadSettings>& loads);

  /// Takes the bed through `n_steps` of `dt` [s], the foot moving linearly to where it has to be at the end.
  void advance(double dt, std::int64_t n_steps);

 private:
  std::vector<double> wanted(double time, double ahead) const;
  double force(double time) const;

  TrackBed& bed_;
  std::vector<std::function<double(double)>> forces_;
  std::function<double(double)> displacement_;
  std::vector<double> foot_;
};

}  // namespace qdem
