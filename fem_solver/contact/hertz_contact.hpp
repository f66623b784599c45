// The wheel's contact as a spring.
#pragma once

#include "fem_solver/contact/hertz.hpp"
#include "fem_solver/contact/wheel_contact.hpp"

namespace fem {

/// Hertz's law, without friction. Keeps no state.
class HertzContact : public WheelContact {
 public:
  /// `static_load` [N].
  HertzContact(const Hertz& hertz, double static_load) : coefficient_(hertz.coefficient()), load_(static_load) {}

  PatchState at_rest(double position, double& approach) const override;
  ContactLaw law(double position, const PatchState& state) const override;
  void roll(double, double, PatchState&) override {}

 private:
  double coefficient_, load_;
};

}  // namespace fem
