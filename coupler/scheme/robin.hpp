// R1 and R2: the rail has the pad in its own equations, held against a predicted sleeper.
#pragma once

#include "coupler/scheme/coupling_scheme.hpp"

namespace coupler {

/// Robin explicit with cumulative carry (R1); with one corrector (R2) in the march. Source: formulation of this
/// project.
class RobinScheme : public CouplingScheme {
 public:
  RobinScheme(SchemeSetup setup, bool corrected) : CouplingScheme(std::move(setup)), corrected_(corrected) {}

 private:
  void solve(WindowRecord& record, Sides sides) override;
  void pass(WindowRecord& record, std::uint32_t iteration, const RobinTarget& target, Sides sides);
  RobinTarget predicted() const;
  /// The rail again, against the mean force that the sleeper's side found in `record` and the pad's law about it.
  RobinTarget corrected(const WindowRecord& record) const;
  double raw_defect(const WindowRecord& record) const;  ///< norm of the Robin force minus the sleeper's mean force [N]

  bool corrected_;
};

}  // namespace coupler
