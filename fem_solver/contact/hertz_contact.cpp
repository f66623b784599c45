#include "fem_solver/contact/hertz_contact.hpp"

#include <algorithm>
#include <cmath>

namespace fem {

ContactLaw hertz_law(double coefficient) {
  return [coefficient](double approach) -> ContactForce {
    const double root = std::sqrt(std::max(approach, 0.0));
    return {coefficient * root * root * root, 1.5 * coefficient * root};
  };
}

PatchState HertzContact::at_rest(double, double& approach) const {
  approach = std::pow(load_ / coefficient_, 2.0 / 3.0);
  return {};
}

ContactLaw HertzContact::law(double, const PatchState&) const {
  return hertz_law(coefficient_);
}

}  // namespace fem
