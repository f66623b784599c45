// One way: the rail drives the sleeper and hears nothing of it.
#pragma once

#include "coupler/scheme/coupling_scheme.hpp"

namespace coupler {

/// The rail stands on stand-in supports (stand_in_laws) that are relaxed in the reference configuration, or is a record
/// of another run; the sleeper follows its path. Nothing is conserved at such an interface; the audit says how much
/// not.
class OneWayScheme : public CouplingScheme {
 public:
  using CouplingScheme::CouplingScheme;

 private:
  void solve(WindowRecord& record, Sides sides) override;
};

/// Laws for the rail's side: every pad in series with a ground spring of `support[i]` [N/m] (empty: the pads alone, as
/// on a rigid sleeper). k K/(k + K); the dashpot counts with the square of the pad's share K/(k + K) of the
/// deformation.
std::vector<proto::PadLaw> stand_in_laws(std::vector<proto::PadLaw> laws, const std::vector<double>& support);

}  // namespace coupler
