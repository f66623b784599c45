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

TEST(ObservedOrder, TableCsvAndPlotNameEveryQuantity) {
  const std::vector<coupler::ObservedOrder> orders{coupler::observed_order(sequence(2.0))};
  const coupler::RefinedBy by{"window [s]", {1.0, 0.5, 0.25, 0.125}};
  EXPECT_NE(coupler::order_table(orders, by).find("order 2.00, 2.00"), std::string::npos);
  const auto csv = coupler::order_csv(orders, by);
  EXPECT_EQ(csv.find("window [s],q [m]\n1,"), 0u) << csv;
  const auto plot = coupler::order_plot(orders, by, 2.0, "a.csv", "a.svg");
  EXPECT_NE(plot.find("set output 'a.svg'"), std::string::npos);
  EXPECT_NE(plot.find("'a.csv' skip 1 using 1:($2/"), std::string::npos) << plot;
}

TEST(ObservedOrder, WhatDoesNotChangeHasNone) {
  coupler::Refinement zero{"z", "m", {{0, 0}, {0, 0}, {0, 0}}}, same{"s", "m", {{1, 2}, {1, 2}, {1, 2 + 1e-15}}};
  const auto none = coupler::observed_order(zero), round_off = coupler::observed_order(same);
  EXPECT_FALSE(none.has_order());
  EXPECT_EQ(none.order_text(), "zero");
  EXPECT_FALSE(round_off.has_order());
  EXPECT_EQ(round_off.order_text(), "the same at all levels");
  const auto table = coupler::order_table({none, round_off}, {"window [s]", {1, 0.5, 0.25}});
  EXPECT_EQ(table.find("nan"), std::string::npos) << table;
}
