#include "qdem_solver/bed/gradation.hpp"

#include <cmath>

namespace qdem::bed {
namespace {

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  if (at <= x.front()) return y.front();
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (at > x[i]) continue;
    return x[i] > x[i - 1] ? y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]) : y[i];
  }
  return y.back();
}

}  // namespace

double Gradation::size_at(double share) const {
  return interpolate(passing, sizes, share);
}
double Gradation::passing_at(double size) const {
  return interpolate(sizes, passing, size);
}

std::vector<Stone> draw_stones(const Gradation& gradation, int n_templates, const StoneVolume& volume_of, double volume,
                               Random& random) {
  const std::size_t n_intervals = gradation.sizes.size() - 1;
  std::vector<double> drawn(n_intervals, 0.0);
  std::vector<Stone> stones;
  for (double total = 0.0; total < volume;) {
    std::size_t lacking = 0;
    double largest = -1.0;
    for (std::size_t i = 0; i < n_intervals; ++i) {
      const double lack = (gradation.passing[i + 1] - gradation.passing[i]) * volume - drawn[i];
      if (lack > largest) largest = lack, lacking = i;
    }
    // Even spread of mass over sizes means a number density like size^-3: its integral is inverted here.
    const double low = std::pow(gradation.sizes[lacking], -2), high = std::pow(gradation.sizes[lacking + 1], -2);
    Stone stone;
    stone.size = 1 / std::sqrt(random.uniform(high, low));
    stone.template_id = static_cast<int>(random.index(n_templates));
    const double own = volume_of(stone.template_id, stone.size);
    drawn[lacking] += own, total += own;
    stones.push_back(stone);
  }
  return stones;
}

void mix_materials(const std::vector<Ingredient>& mixture, const StoneVolume& volume_of, std::vector<Stone>& stones) {
  std::vector<double> given(mixture.size(), 0.0);
  double whole = 0.0, total = 0.0;
  for (const Ingredient& part : mixture) whole += part.share;
  for (Stone& stone : stones) {
    const double own = volume_of(stone.template_id, stone.size);
    total += own;
    std::size_t lacking = 0;
    for (std::size_t i = 1; i < mixture.size(); ++i) {
      const auto lack = [&](std::size_t part) { return mixture[part].share / whole * total - given[part]; };
      if (lack(i) > lack(lacking)) lacking = i;
    }
    given[lacking] += own;
    stone.material_id = mixture[lacking].material_id;
  }
}

}  // namespace qdem::bed
