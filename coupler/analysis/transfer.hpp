// Frequency response from the sleeper's bottom to the stones.
#pragma once

#include <vector>

#include "coupler/analysis/spectrum.hpp"

namespace coupler::analysis {

/// Response of one stone, per spectral line.
struct Response {
  std::vector<double> magnitude;  ///< |U_stone| / |U_bottom| [-]
  std::vector<double> coherence;  ///< share of the stone's power that follows the bottom linearly, 0 to 1; with one
                                  ///< segment it is 1 whatever the records hold
};

/// What the stones are compared with: motion of the sleeper's bottom in cells of equal area.
///
/// |U_bottom|^2 is the mean over the cells of their power density. (A mean of the motion itself would vanish at the
/// sleeper's bending modes and put poles into the response.) For a sleeper that moves as a rigid body in translation
/// the two are the same.
class BottomReference {
 public:
  /// `cells`: the cells' records, cut alike.
  explicit BottomReference(std::vector<SegmentTransforms> cells);

  /// sqrt(S_stone / S_bottom); coherence with the cell `nearest` to the stone.
  Response response(const SegmentTransforms& stone, std::size_t nearest) const;
  const std::vector<double>& frequency() const { return cells_.front().frequency; }
  const std::vector<double>& power() const { return power_; }  ///< S_bottom

 private:
  std::vector<SegmentTransforms> cells_;
  std::vector<double> power_;
};

/// Mean of `values` over the lines within [low, high] [Hz]; NaN where there is none.
double band_mean(const std::vector<double>& frequency, const std::vector<double>& values, double low, double high);

}  // namespace coupler::analysis
