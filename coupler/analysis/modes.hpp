// Natural frequencies and damping from free decay.
#pragma once

#include <cstddef>
#include <vector>

#include "proto/span.hpp"

namespace coupler::analysis {

/// A term amplitude exp(-zeta w t) cos(w_d t + phase) of a decay.
struct Mode {
  double frequency = 0.0;  ///< undamped, w / 2 pi [Hz]
  double damping = 0.0;    ///< zeta, ratio to critical [-]
  double amplitude = 0.0;  ///< at the record's begin [unit of the record]
};

struct RealisationOptions {
  double highest_frequency =
      1000.0;                      ///< of interest [Hz]: the record is averaged in blocks to 2.5 times as much or more
  std::size_t largest_order = 20;  ///< of the system: twice the number of modes
  double tolerance = 1e-3;         ///< singular values below this times the largest are noise
};

/// Modes by the eigensystem realisation algorithm (Juang and Pappa, J. Guidance 8, 1985, 620-627): the Hankel matrix of
/// the decay is cut to its leading singular values, the system matrix between it and its shift has the modes as
/// eigenvalues. Amplitudes by least squares. Damped oscillations below the highest frequency are returned, largest
/// amplitude first. Averaging in blocks keeps the modes of a decay as they are (amplitudes are corrected for it).
/// Empty for a record of fewer than 16 blocks, or of zeros. Contacts that open and close make a decay nonlinear: then
/// these are the modes of the linear system that fits best, and their damping depends on the amplitude.
std::vector<Mode> eigensystem_realisation(proto::Span<const double> decay, double dt,
                                          const RealisationOptions& options);

}  // namespace coupler::analysis
