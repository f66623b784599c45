#include "coupler/study/analyses.hpp"

namespace coupler::study {

Run::Run(const std::string& folder)
    : files(folder), stones(files.stones()), bottom(files.bottom()), footprint(files.footprint()), load(files.load()) {}

Findings analyse(const std::string& folder, const Options& options) {
  const Run run(folder);
  Findings findings;
  for (const auto add : {add_load, add_histories, add_transfer, add_attenuation, add_modes, add_displacement_field,
                         add_pressure, add_settlement, add_force_chains, add_energies}) {
    add(run, options, findings);
  }
  return findings;
}

}  // namespace coupler::study
