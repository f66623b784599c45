// E0, E1, E2: the rail is loaded with a mean force known from the windows before.
#pragma once

#include "coupler/scheme/coupling_scheme.hpp"

namespace coupler {

/// E1: conventional serial staggered; E2: the same with the force extrapolated; E0: both sides at the same time, the
/// sleeper along the rail's extrapolated path u_n + s H u'_n (march only; before it E0 is E1).
/// Source: Farhat, Lesoinne, Comput. Methods Appl. Mech. Engrg. 182 (2000) 499-515 (staggered procedures, E0 and E1).
class StaggeredScheme : public CouplingScheme {
 public:
  enum class Kind { parallel, serial, extrapolated };
  StaggeredScheme(SchemeSetup setup, Kind kind) : CouplingScheme(std::move(setup)), kind_(kind) {}

 private:
  void solve(WindowRecord& record, Sides sides) override;
  void solve_in_parallel(WindowRecord& record, Sides sides);

  Kind kind_;
};

}  // namespace coupler
