// Places in ascending arrays.
#pragma once

#include <cstdint>

#include "proto/span.hpp"

namespace qdem::device {

using Count = long long;

/// Least i in [0, n] for which `before` does not hold; it holds for everything below, and for nothing from there on.
template <class Before>
HOUSE_HOST_DEVICE inline std::int64_t first_not(std::int64_t n, const Before& before) {
  std::int64_t low = 0, high = n;
  while (low < high) {
    const std::int64_t middle = (low + high) / 2;
    if (before(middle)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/// Part that a value belongs to: the largest i with offsets[i] <= value, of n + 1 ascending offsets; offsets[0] <=
/// value < offsets[n].
template <class Offset>
HOUSE_HOST_DEVICE inline std::int64_t part_of(const Offset* offsets, std::int64_t n, std::int64_t value) {
  return first_not(n, [&](std::int64_t i) { return offsets[i] <= value; }) - 1;
}

}  // namespace qdem::device
