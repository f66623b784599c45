// Which elements meet at a node.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace qdem {

/// CSR: node -> n_corners * element + corner, ascending.
struct Adjacency {
  std::vector<int> offsets, slots;
};

/// Of elements whose nodes lie in [0, n_nodes); a node without elements has an empty row.
template <std::size_t n_corners>
Adjacency make_adjacency(int n_nodes, const std::vector<std::array<int, n_corners>>& elements) {
  std::vector<std::vector<int>> rows(n_nodes);
  int slot = 0;
  for (const auto& element : elements) {
    for (const int node : element) rows[node].push_back(slot++);
  }
  Adjacency result;
  result.offsets.push_back(0);
  for (const auto& row : rows) {
    result.slots.insert(result.slots.end(), row.begin(), row.end());
    result.offsets.push_back(static_cast<int>(result.slots.size()));
  }
  return result;
}

}  // namespace qdem
