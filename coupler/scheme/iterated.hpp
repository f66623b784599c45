// The implicit scheme: both sides solve a window again and again until the mean force reproduces itself.
#pragma once

#include <memory>

#include "coupler/scheme/acceleration.hpp"
#include "coupler/scheme/coupling_scheme.hpp"

namespace coupler {

/// Block Gauss-Seidel on the mean force over the window, beginning with the extrapolated one, accelerated as the case
/// says. Converged when both hold, relative to the largest norm seen so far: the residual of the mean force, and the
/// change of the rail's displacement since the iterate before. In the initialise phase one pass a window, as E1.
class IteratedScheme : public CouplingScheme {
 public:
  IteratedScheme(SchemeSetup setup, const proto::Iteration& settings);

 private:
  void solve(WindowRecord& record, Sides sides) override;
  void pass(WindowRecord& record, std::uint32_t iteration, std::vector<double> force, Sides sides);
  bool has_converged(const WindowRecord& record, const std::vector<double>& rail_before) const;
  void give_up(WindowRecord& record) const;
  std::vector<double> mean_force(const WindowRecord& record) const;

  proto::Iteration settings_;
  std::unique_ptr<Acceleration> acceleration_;
};

}  // namespace coupler
