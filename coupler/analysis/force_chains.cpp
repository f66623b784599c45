#include "coupler/analysis/force_chains.hpp"

#include <algorithm>
#include <limits>
#include <set>

namespace coupler::analysis {
namespace {

using Pair = std::pair<int, int>;

std::set<Pair> pairs_of(const std::vector<PairContact>& contacts) {
  std::set<Pair> pairs;
  for (const auto& contact : contacts) pairs.insert({contact.body_a, contact.body_b});
  return pairs;
}

double sum_of_forces(const std::vector<PairContact>& contacts) {
  double sum = 0.0;
  for (const auto& contact : contacts) sum += contact.force;
  return sum;
}

}  // namespace

ChainFigures chain_figures(const std::vector<PairContact>& contacts) {
  ChainFigures figures;
  figures.n_pairs = contacts.size();
  if (contacts.empty()) return figures;
  const double n = static_cast<double>(contacts.size()), sum = sum_of_forces(contacts);
  figures.mean_force = sum / n;
  double squares = 0.0, strong = 0.0, strong_sum = 0.0;
  for (const auto& contact : contacts) {
    const double force = contact.force;
    figures.largest_force = std::max(figures.largest_force, force);
    squares += force * force;
    if (force > figures.mean_force) ++strong, strong_sum += force;
  }
  figures.strong_share = strong / n;
  figures.strong_force_share = sum > 0 ? strong_sum / sum : 0.0;
  figures.participation = squares > 0 ? sum * sum / (n * squares) : 0.0;
  return figures;
}

double coordination(const std::vector<PairContact>& contacts, const std::set<int>& bodies) {
  std::size_t ends = 0;
  for (const auto& [a, b, force] : contacts) {
    if (b >= 0) ends += bodies.count(a) + bodies.count(b);
  }
  return bodies.empty() ? 0.0 : static_cast<double>(ends) / static_cast<double>(bodies.size());
}

std::vector<double> force_distribution(const std::vector<PairContact>& contacts, double largest, std::size_t n_bins) {
  std::vector<double> density(n_bins, 0.0);
  const double n = static_cast<double>(contacts.size()), mean = sum_of_forces(contacts) / n;
  if (contacts.empty() || !(mean > 0)) return density;
  const double width = largest / static_cast<double>(n_bins);
  for (const auto& contact : contacts) {
    const auto bin = static_cast<std::size_t>(contact.force / mean / width);
    if (bin < n_bins) density[bin] += 1 / (n * width);
  }
  return density;
}

double lost_share(const std::vector<PairContact>& before, const std::vector<PairContact>& after) {
  const auto then = pairs_of(before), now = pairs_of(after);
  if (then.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto lost = std::count_if(then.begin(), then.end(), [&](const Pair& pair) { return now.count(pair) == 0; });
  return static_cast<double>(lost) / static_cast<double>(then.size());
}

}  // namespace coupler::analysis
