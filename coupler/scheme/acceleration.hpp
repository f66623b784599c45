// How an implicit scheme gets its next mean force from the last one and from what the sleeper made of it.
#pragma once

#include <memory>
#include <vector>

#include "coupler/scheme/scheme_state.hpp"
#include "proto/case/coupling.hpp"

namespace coupler {

/// Finds z = g(z): from an iterate z and its image g(z) the next iterate; the residual is r = g(z) - z. Holds no
/// memory: that is in the state it is given.
class Acceleration {
 public:
  virtual ~Acceleration() = default;

  /// Next iterate of this window. Keeps in `memory` what later iterations need.
  virtual std::vector<double> next(AccelerationState& memory, const std::vector<double>& iterate,
                                   const std::vector<double>& image) const = 0;

  /// The window has converged with `iterate` and `image`; keeps what later windows may use.
  virtual void end_window(AccelerationState& memory, const std::vector<double>& iterate,
                          const std::vector<double>& image) const;
};

/// z + w r with the same w always.
class ConstantRelaxation : public Acceleration {
 public:
  explicit ConstantRelaxation(double relaxation) : relaxation_(relaxation) {}
  std::vector<double> next(AccelerationState& memory, const std::vector<double>& iterate,
                           const std::vector<double>& image) const override;

 private:
  double relaxation_;
};

/// z + w r, w_k = -w_k-1 r_k-1 . (r_k - r_k-1) / |r_k - r_k-1|^2, |w| kept within [0.05, 2]. A window begins with the
/// last w of the one before, the run with `relaxation`.
/// Source: Kuettler, Wall, Comput. Mech. 43 (2008) 61-72.
class AitkenRelaxation : public Acceleration {
 public:
  explicit AitkenRelaxation(double relaxation) : relaxation_(relaxation) {}
  std::vector<double> next(AccelerationState& memory, const std::vector<double>& iterate,
                           const std::vector<double>& image) const override;

 private:
  double relaxation_;
};

/// The acceleration that the case asks for.
std::unique_ptr<Acceleration> make_acceleration(const proto::Iteration& iteration);

/// image - iterate.
std::vector<double> residual_of(const std::vector<double>& iterate, const std::vector<double>& image);

/// iterate + w (image - iterate).
std::vector<double> relaxed(const std::vector<double>& iterate, const std::vector<double>& image, double relaxation);

}  // namespace coupler
