// Observed orders of sequences whose order is known.
#include "coupler/report/convergence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/tolerance.hpp"

namespace {

/// exact + c h^p at three places, four halvings of h = 1.
coupler::Refinement sequence(double order) {
  coupler::Refinement quantity{"q", "m", {}};
  for (int l = 0; l < 4; ++l) {
    const double error = 0.01 * std::exp2(-order * l);
    quantity.levels.push_back({1 + error, -2 + 3 * error, 0.5 - error});
  }
  return quantity;
}

}  // namespace

TEST(ObservedOrder, IsThatOfTheSequence) {
  for (const double order : {1.0, 2.0, 3.0}) {
    const auto found = coupler::observed_order(sequence(order));
    ASSERT_EQ(found.distances.size(), 3u);
    ASSERT_EQ(found.orders.size(), 2u);
    for (const double p : found.orders) EXPECT_TRUE(tests::near_abs(p, order, 1e-9));
    const double true_error = 0.01 * std::exp2(-3 * order) * std::sqrt((1 + 9 + 1) / 3.0);
    EXPECT_TRUE(tests::near_rel(found.error, true_error, 1e-9));
  }
}

TEST(ObservedOrder, TableAndCsvNameEveryQuantity) {
  const std::vector<coupler::ObservedOrder> orders{coupler::observed_order(sequence(2.0))};
  const std::vector<double> windows{1.0, 0.5, 0.25, 0.125};
  EXPECT_NE(coupler::order_table(orders, windows).find("order 2.00, 2.00"), std::string::npos);
  const auto csv = coupler::order_csv(orders, windows);
  EXPECT_EQ(csv.find("window_s,q [m]\n1,"), 0u) << csv;
}
