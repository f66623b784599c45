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

std::string order_table(const std::vector<ObservedOrder>& orders, const std::vector<double>& windows_s) {
  std::string text = fmt::format("\nobserved orders, windows of {:g} s\n", fmt::join(windows_s, ", "));
  for (const auto& order : orders) {
    text += fmt::format("  {:<34} order {:.2f}   finest {:.4g} +- {:.1g} {}\n", order.name,
                        fmt::join(order.orders, ", "), order.size, std::abs(order.error), order.unit);
  }
  return text;
}

std::string order_csv(const std::vector<ObservedOrder>& orders, const std::vector<double>& windows_s) {
  std::string text = "window_s";
  for (const auto& order : orders) text += fmt::format(",{} [{}]", order.name, order.unit);
  text += "\n";
  for (std::size_t l = 0; l + 1 < windows_s.size(); ++l) {
    text += fmt::format("{:.17g}", windows_s[l]);
    for (const auto& order : orders) text += fmt::format(",{:.9g}", order.distances[l]);
    text += "\n";
  }
  return text;
}

}  // namespace coupler
