// What an analysis is asked for.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "coupler/analysis/spectrum.hpp"

namespace coupler::study {

struct Band {
  double low = 0.0, high = 0.0;  ///< [Hz]
};

struct Options {
  std::size_t n_bins = 4;  ///< depth bins from the sleeper's bottom to the lowest stone under it
  double reach = 0.0;      ///< how far beside the sleeper's bottom a stone may lie to count as under it [m]
  int axis = 2;            ///< of T(f,z): 0 along the track, 1 across, 2 vertical
  double segment = 0.0;    ///< of the spectral densities [s]; 0: half of the record
  double overlap = 0.5;    ///< share of a segment
  analysis::Window window = analysis::Window::hann;
  Band low{0.0, 100.0};                       ///< "low" frequencies of T(f,z); its line at 0 never counts
  Band high{300.0, 800.0};                    ///< "high" ones
  double highest_mode = 1000.0;               ///< modes above are not looked for [Hz]
  std::optional<double> decay_from;           ///< begin of the free decay [s]
  std::vector<std::array<double, 3>> chosen;  ///< places whose nearest stones get histories of their own [m]
};

}  // namespace coupler::study
