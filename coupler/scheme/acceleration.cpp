#include "coupler/scheme/acceleration.hpp"

#include <algorithm>
#include <cmath>

#include "coupler/scheme/iqn_ils.hpp"

namespace coupler {

std::vector<double> residual_of(const std::vector<double>& iterate, const std::vector<double>& image) {
  std::vector<double> residual = image;
  for (std::size_t i = 0; i < residual.size(); ++i) residual[i] -= iterate[i];
  return residual;
}

std::vector<double> relaxed(const std::vector<double>& iterate, const std::vector<double>& image, double relaxation) {
  std::vector<double> next = iterate;
  for (std::size_t i = 0; i < next.size(); ++i) next[i] += relaxation * (image[i] - iterate[i]);
  return next;
}

void Acceleration::end_window(AccelerationState& memory, const std::vector<double>&, const std::vector<double>&) const {
  memory.residual.clear();
  memory.image.clear();
}

std::vector<double> ConstantRelaxation::next(AccelerationState& memory, const std::vector<double>& iterate,
                                             const std::vector<double>& image) const {
  memory.relaxation = relaxation_;
  return relaxed(iterate, image, relaxation_);
}

std::vector<double> AitkenRelaxation::next(AccelerationState& memory, const std::vector<double>& iterate,
                                           const std::vector<double>& image) const {
  auto residual = residual_of(iterate, image);
  if (memory.relaxation == 0.0) memory.relaxation = relaxation_;
  if (!memory.residual.empty()) {
    double product = 0.0, square = 0.0;
    for (std::size_t i = 0; i < residual.size(); ++i) {
      const double change = residual[i] - memory.residual[i];
      product += memory.residual[i] * change;
      square += change * change;
    }
    // Without a change there is nothing to learn: 0/0 at convergence.
    if (square > 0.0) memory.relaxation *= -product / square;
    memory.relaxation = std::copysign(std::clamp(std::abs(memory.relaxation), 0.05, 2.0), memory.relaxation);
  }
  memory.residual = std::move(residual);
  return relaxed(iterate, image, memory.relaxation);
}

std::unique_ptr<Acceleration> make_acceleration(const proto::Iteration& iteration) {
  switch (iteration.acceleration) {
    case proto::Iteration::Acceleration::constant:
      return std::make_unique<ConstantRelaxation>(iteration.relaxation);
    case proto::Iteration::Acceleration::aitken:
      return std::make_unique<AitkenRelaxation>(iteration.relaxation);
    case proto::Iteration::Acceleration::iqn_ils:
      break;
  }
  return std::make_unique<IqnIls>(iteration);
}

}  // namespace coupler
