// Statistics of the forces between bodies.
#pragma once

#include <cstddef>
#include <set>
#include <utility>
#include <vector>

namespace coupler::analysis {

/// One pair of touching bodies.
struct PairContact {
  int body_a = 0, body_b = 0;  ///< b < 0: a plane
  double force = 0.0;          ///< magnitude of the resultant [N]
};

struct ChainFigures {
  std::size_t n_pairs = 0;
  double mean_force = 0.0, largest_force = 0.0;  ///< of the pairs [N]
  double strong_share = 0.0;                     ///< share of pairs that carry more than the mean [-]
  double strong_force_share = 0.0;               ///< share of the sum of forces that these carry [-]
  double participation = 0.0;  ///< (sum f)^2 / (n sum f^2): 1 when all carry the same, 1/n when one carries all [-]
};

ChainFigures chain_figures(const std::vector<PairContact>& contacts);

/// Mean number of other bodies (not planes) that each of `bodies` touches [-]; 0 for no bodies.
double coordination(const std::vector<PairContact>& contacts, const std::set<int>& bodies);

/// Probability density of force over mean force, in `n_bins` bins up to `largest` times the mean; what is beyond is
/// left out, so the integral is the share inside.
std::vector<double> force_distribution(const std::vector<PairContact>& contacts, double largest, std::size_t n_bins);

/// Share of the pairs of `before` that no longer touch in `after` [-]; NaN where there was none.
double lost_share(const std::vector<PairContact>& before, const std::vector<PairContact>& after);

}  // namespace coupler::analysis
