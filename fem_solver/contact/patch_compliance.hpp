// What a patch's solvers ask of the bodies in contact.
#pragma once

#include "fem_solver/contact/patch_grid.hpp"

namespace fem {

/// A vector per element: components along (x) and across (y) the rail.
struct PatchVectors {
  PatchField x, y;

  static PatchVectors zeros(const PatchGrid& grid) { return {grid.zeros(), grid.zeros()}; }
  PatchField norm() const { return (x.square() + y.square()).sqrt(); }
};

/// Normal displacement of both surfaces, apart, under pressure. Symmetric and positive definite.
class NormalCompliance {
 public:
  virtual ~NormalCompliance() = default;
  /// displacement += compliance * traction in `box`, which must hold every element with traction. [m] from [Pa]
  virtual void add(const PatchBox& box, const PatchField& traction, PatchField& displacement) const = 0;
  /// A size of an element's displacement under its own traction [m/Pa].
  virtual double self() const = 0;
};

/// Tangential displacement of the wheel over the rail under shear on the wheel; otherwise the same.
class ShearCompliance {
 public:
  virtual ~ShearCompliance() = default;
  virtual void add(const PatchBox& box, const PatchVectors& traction, PatchVectors& displacement) const = 0;
  virtual double self() const = 0;
};

}  // namespace fem
