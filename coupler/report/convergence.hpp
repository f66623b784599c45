// Observed orders of a sequence of runs whose window is halved from one to the next.
#pragma once

#include <string>
#include <vector>

namespace coupler {

/// A quantity of every run, the coarsest first, sampled at the instants of the coarsest run.
struct Refinement {
  std::string name, unit;
  std::vector<std::vector<double>> levels;
};

/// What the levels say about one quantity. Distances are root mean squares over all samples.
struct ObservedOrder {
  std::string name, unit;
  std::vector<double> distances;  ///< between successive levels, n - 1
  std::vector<double> orders;     ///< log2 of successive distances' ratio, n - 2
  double size = 0.0;              ///< of the finest level
  double error = 0.0;             ///< of the finest level, by Richardson with the last order: d / (2^p - 1)
  double last() const { return orders.back(); }
};

/// Of three levels or more. Source: Roache, Verification of Codes and Calculations (2009), grid convergence.
ObservedOrder observed_order(const Refinement& quantity);

/// For people: one line a quantity.
std::string order_table(const std::vector<ObservedOrder>& orders, const std::vector<double>& windows_s);

/// For plots: window_s, then a column of distances for every quantity; a row for every level but the finest.
std::string order_csv(const std::vector<ObservedOrder>& orders, const std::vector<double>& windows_s);

}  // namespace coupler
