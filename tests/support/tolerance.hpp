// The one place where tests say how close is close enough.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tests {

/// |value - target| <= tolerance, both sides of a signed error.
inline ::testing::AssertionResult near_abs(double value, double target, double tolerance) {
  if (std::abs(value - target) <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << value << " is not within " << tolerance << " of " << target;
}

/// |value - target| <= tolerance * |target|.
inline ::testing::AssertionResult near_rel(double value, double target, double tolerance) {
  if (std::abs(value - target) <= tolerance * std::abs(target)) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << value << " differs from " << target << " by "
                                       << std::abs(value / target - 1) << " (relative), allowed " << tolerance;
}

/// Least-squares slope of log(error) over log(step).
inline double fitted_order(const std::vector<double>& steps, const std::vector<double>& errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double n = static_cast<double>(steps.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double x = std::log(steps[i]), y = std::log(errors[i]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// The fitted order lies within `tolerance` of `order`.
inline ::testing::AssertionResult converges_with_order(const std::vector<double>& steps, const std::vector<double>& errors,
                                                       double order, double tolerance) {
  const double found = fitted_order(steps, errors);
  if (std::abs(found - order) <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "order " << found << " instead of " << order << " +- " << tolerance;
}

}  // namespace tests
