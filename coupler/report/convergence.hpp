// Observed orders of a sequence of runs that are refined by two from one to the next.
#pragma once

#include <string>
#include <vector>

namespace coupler {

/// A quantity of every run, the coarsest first, sampled at the same instants.
struct Refinement {
  std::string name, unit;
  std::vector<std::vector<double>> levels;
};

/// What is refined: "window [s]" and its values, the coarsest first.
struct RefinedBy {
  std::string name;
  std::vector<double> values;
};

/// What the levels say about one quantity. Distances are root mean squares over all samples.
struct ObservedOrder {
  std::string name, unit;
  std::vector<double> distances;  ///< between successive levels, n - 1
  std::vector<double> orders;     ///< log2 of successive distances' ratio, n - 2; of no meaning unless has_order()
  double size = 0.0;              ///< of the finest level
  double error = 0.0;             ///< of the finest level, by Richardson with the last order: d / (2^p - 1)
  double last() const { return orders.back(); }
  /// False where the levels do not differ beyond round-off (1e-13 of the size): the quantity is zero, or the same in
  /// all.
  bool has_order() const { return distances.back() > 1e-13 * size && distances[distances.size() - 2] > 0.0; }
  /// "order 1.98, 2.01", "zero", or "the same at all levels".
  std::string order_text() const;
};

/// Of three levels or more. Source: Roache, Verification of Codes and Calculations (2009), grid convergence.
ObservedOrder observed_order(const Refinement& quantity);

/// For people: one line a quantity.
std::string order_table(const std::vector<ObservedOrder>& orders, const RefinedBy& by);

/// For plots: what is refined, then a column of distances for every quantity; a row for every level but the finest.
std::string order_csv(const std::vector<ObservedOrder>& orders, const RefinedBy& by);

/// Commands for gnuplot: reads `csv`, draws the distances and the slope of `expected_order` into `svg`, both axes
/// logarithmic.
std::string order_plot(const std::vector<ObservedOrder>& orders, const RefinedBy& by, double expected_order,
                       const std::string& csv, const std::string& svg);

}  // namespace coupler
