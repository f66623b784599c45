// What the search around one body finds.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "qdem_solver/contact/candidates.hpp"

namespace qdem::detail {

/// Is q inside the box grown by `reach`?
inline bool near_box(const BodyBox& box, const Eigen::Vector3d& q, double reach) {
  return (q.array() >= box.low.array() - reach).all() && (q.array() <= box.high.array() + reach).all();
}

inline bool boxes_near(const BodyBox& a, const BodyBox& b, double reach) {
  return (a.low.array() <= b.high.array() + reach).all() && (b.low.array() <= a.high.array() + reach).all();
}

/// Candidates of one body, its own part of the list.
struct Found {
  std::vector<ContactKey> keys;
  std::vector<int> triangle_counts, triangles;
};

/// Puts one body's entries in key order.
inline void sort_found(Found& found) {
  std::vector<int> order(found.keys.size()), first(found.keys.size());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = 1; i < first.size(); ++i) first[i] = first[i - 1] + found.triangle_counts[i - 1];
  std::sort(order.begin(), order.end(), [&](int i, int j) { return found.keys[i] < found.keys[j]; });
  Found sorted;
  for (const int i : order) {
    sorted.keys.push_back(found.keys[i]);
    sorted.triangle_counts.push_back(found.triangle_counts[i]);
    const auto begin = found.triangles.begin() + first[i];
    sorted.triangles.insert(sorted.triangles.end(), begin, begin + found.triangle_counts[i]);
  }
  found = std::move(sorted);
}

}  // namespace qdem::detail
