#include "coupler/scheme/dual_schur.hpp"
#include "coupler/scheme/iterated.hpp"
#include "coupler/scheme/one_way.hpp"
#include "coupler/scheme/robin.hpp"
#include "coupler/scheme/staggered.hpp"

namespace coupler {

std::unique_ptr<CouplingScheme> make_scheme(proto::Scheme scheme, const proto::Coupling& coupling, SchemeSetup setup) {
  using proto::Scheme;
  setup.prolongation = coupling.prolongation;
  setup.sub_cycle_factor = static_cast<std::uint32_t>(coupling.sub_cycle_factor);
  setup.fixed_sub_cycles = proto::is_rigid(scheme);
  switch (scheme) {
    case Scheme::robin_explicit:
      return std::make_unique<RobinScheme>(std::move(setup), false);
    case Scheme::robin_corrected:
      return std::make_unique<RobinScheme>(std::move(setup), true);
    case Scheme::parallel_staggered:
      return std::make_unique<StaggeredScheme>(std::move(setup), StaggeredScheme::Kind::parallel);
    case Scheme::serial_staggered:
      return std::make_unique<StaggeredScheme>(std::move(setup), StaggeredScheme::Kind::serial);
    case Scheme::serial_extrapolated:
      return std::make_unique<StaggeredScheme>(std::move(setup), StaggeredScheme::Kind::extrapolated);
    case Scheme::implicit:
      return std::make_unique<IteratedScheme>(std::move(setup), coupling.iteration);
    case Scheme::one_way:
      return std::make_unique<OneWayScheme>(std::move(setup));
    case Scheme::rigid_per_step:
      return std::make_unique<RigidPerStep>(std::move(setup));
    case Scheme::rigid_per_window:
      break;
  }
  return std::make_unique<RigidPerWindow>(std::move(setup));
}

}  // namespace coupler
