// The analyses of a run. Each adds its tables and figures, or a note that says what it lacks.
#pragma once

#include "coupler/study/findings.hpp"
#include "coupler/study/options.hpp"
#include "coupler/study/run_files.hpp"

namespace coupler::study {

/// What several analyses need; read once.
struct Run {
  explicit Run(const std::string& folder);

  RunFiles files;
  std::optional<analysis::Motion> stones, bottom;
  std::optional<analysis::Footprint> footprint;
  std::optional<Load> load;
};

/// Histories of seats, bottom, sensing and chosen stones, with amplitude spectra and Welch densities.
void add_histories(const Run& run, const Options& options, Findings& findings);
/// Peak of the load, the unloading after it, and the spectral centre of the bottom's motion before and after the peak.
void add_load(const Run& run, const Options& options, Findings& findings);
/// T(f,z), its bands, and the fall of motion with depth.
void add_transfer(const Run& run, const Options& options, Findings& findings);
void add_attenuation(const Run& run, const Options& options, Findings& findings);
/// Modes of bottom, sensing stones and depth bins from their free decay.
void add_modes(const Run& run, const Options& options, Findings& findings);
/// Displacement of all stones at the peak of the load, and how it falls with the distance from the sleeper.
void add_displacement_field(const Run& run, const Options& options, Findings& findings);
/// Pressure under the sleeper, and the largest stress in a stone over its mean.
void add_pressure(const Run& run, const Options& options, Findings& findings);
/// Settlement of the sleeper from cycle to cycle; nothing where the load has no two cycles.
void add_settlement(const Run& run, const Options& options, Findings& findings);
void add_force_chains(const Run& run, const Options& options, Findings& findings);
/// Every column of qdem.h5 that is an energy, and what the rail gave.
void add_energies(const Run& run, const Options& options, Findings& findings);

/// All of them, in the order in which they are printed. Throws what RunFiles throws.
Findings analyse(const std::string& folder, const Options& options);

}  // namespace coupler::study
