// Square root of a number or of every lane of a vector.
#pragma once

#include <cmath>
#include <type_traits>

#include "proto/span.hpp"

namespace qdem {

template <class Real>
HOUSE_HOST_DEVICE inline Real square_root(Real value) {
  if constexpr (std::is_floating_point_v<Real>) {
    return sqrt(value);
  } else {
    for (unsigned lane = 0; lane < sizeof(Real) / sizeof(double); ++lane) value[lane] = __builtin_sqrt(value[lane]);
    return value;
  }
}

}  // namespace qdem
