// IQN-ILS: a quasi-Newton step from secants of this window and of windows before.
#pragma once

#include "coupler/scheme/acceleration.hpp"

namespace coupler {

/// With V the differences of residuals and W those of images, newest column first: c = argmin |V c + r|, next iterate
/// g(z) + W c. Columns: this window's, then those of `reused_windows` windows before, at most min(n, 20).
/// QR2 filter: a column is forgotten when less than `filter` of it is new against the newer ones (modified
/// Gram-Schmidt). Stall guard: a step that is nothing against the residual forgets the oldest half of the columns and
/// relaxes instead. Sources: Degroote, Bathe, Vierendeels, Comput. Struct. 87 (2009) 793-801; Haelterman et al.,
/// Comput. Struct. 171 (2016) 9-17 (filters).
class IqnIls : public Acceleration {
 public:
  explicit IqnIls(const proto::Iteration& settings) : settings_(settings) {}
  std::vector<double> next(AccelerationState& memory, const std::vector<double>& iterate,
                           const std::vector<double>& image) const override;
  void end_window(AccelerationState& memory, const std::vector<double>& iterate,
                  const std::vector<double>& image) const override;

 private:
  /// Adds the secant to the iterate before, if there was one in this window.
  static void learn(AccelerationState& memory, const std::vector<double>& residual, const std::vector<double>& image);
  void filter(AccelerationState& memory) const;

  proto::Iteration settings_;
};

}  // namespace coupler
