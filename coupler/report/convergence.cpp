#include "coupler/report/convergence.hpp"

#include <fmt/format.h>

#include <cmath>

namespace coupler {
namespace {

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double distance(std::vector<double> p, const std::vector<double>& q) {
  for (std::size_t i = 0; i < p.size(); ++i) p[i] -= q[i];
  return root_mean_square(p);
}

}  // namespace

ObservedOrder observed_order(const Refinement& quantity) {
  ObservedOrder result{quantity.name, quantity.unit, {}, {}};
  for (std::size_t l = 0; l + 1 < quantity.levels.size(); ++l) {
    result.distances.push_back(distance(quantity.levels[l], quantity.levels[l + 1]));
  }
  for (std::size_t l = 0; l + 1 < result.distances.size(); ++l) {
    result.orders.push_back(std::log2(result.distances[l] / result.distances[l + 1]));
  }
  result.size = root_mean_square(quantity.levels.back());
  result.error = result.distances.back() / (std::exp2(result.last()) - 1);
  return result;
}

std::string ObservedOrder::order_text() const {
  if (size == 0.0 && distances.back() == 0.0) return "zero";
  if (!has_order()) return "the same at all levels";
  return fmt::format("order {:.2f}", fmt::join(orders, ", "));
}

std::string order_table(const std::vector<ObservedOrder>& orders, const RefinedBy& by) {
  std::string text = fmt::format("\nobserved orders, {} {:g}\n", by.name, fmt::join(by.values, ", "));
  for (const auto& order : orders) {
    text += fmt::format("  {:<34} {}   finest {:.4g}", order.name, order.order_text(), order.size);
    text += order.has_order() ? fmt::format(" +- {:.1g} {}\n", std::abs(order.error), order.unit)
                              : fmt::format(" {}\n", order.unit);
  }
  return text;
}

std::string order_csv(const std::vector<ObservedOrder>& orders, const RefinedBy& by) {
  std::string text = by.name;
  for (const auto& order : orders) text += fmt::format(",{} [{}]", order.name, order.unit);
  text += "\n";
  for (std::size_t l = 0; l + 1 < by.values.size(); ++l) {
    text += fmt::format("{:.17g}", by.values[l]);
    for (const auto& order : orders) text += fmt::format(",{:.9g}", order.distances[l]);
    text += "\n";
  }
  return text;
}

std::string order_plot(const std::vector<ObservedOrder>& orders, const RefinedBy& by, double expected_order,
                       const std::string& csv, const std::string& svg) {
  std::string text = fmt::format(
      "set terminal svg size 800,600\nset output '{}'\nset datafile separator ','\nset logscale xy\n"
      "set format y '%.0e'\nset xlabel '{}'\nset ylabel 'distance to the next level, relative'\nset key left top\n"
      "plot (x/{:g})**{:g} title 'order {:g}' dashtype 2",
      svg, by.name, by.values.front(), expected_order, expected_order);
  for (std::size_t i = 0; i < orders.size(); ++i)
    if (orders[i].has_order())
      text += fmt::format(", \\\n  '{}' skip 1 using 1:(${}/{:.9g}) with linespoints title '{}'", csv, i + 2,
                          orders[i].distances.front(), orders[i].name);
  return text + "\n";
}

}  // namespace coupler
