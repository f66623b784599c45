#include "qdem_solver/bed/sleeper_shape.hpp"

#include <algorithm>
#include <cmath>

namespace qdem::bed {

Template box_shape(const std::string& name, const Eigen::Vector3d& low, const Eigen::Vector3d& high, double cell) {
  const Eigen::Vector3d size = high - low;
  std::array<int, 3> n;
  for (int c = 0; c < 3; ++c) n[c] = std::max(1, static_cast<int>(std::lround(size[c] / cell)));
  const auto number = [&](const std::array<int, 3>& at) { return (at[2] * (n[1] + 1) + at[1]) * (n[0] + 1) + at[0]; };
  std::vector<Eigen::Vector3d> nodes;
  for (int k = 0; k <= n[2]; ++k) {
    for (int j = 0; j <= n[1]; ++j) {
      for (int i = 0; i <= n[0]; ++i) {
        nodes.push_back(low + size.cwiseProduct(Eigen::Vector3d(double(i) / n[0], double(j) / n[1], double(k) / n[2])));
      }
    }
  }
  // The six ways from a cell's first corner to its last along its edges; the last three are left-handed.
  constexpr int ways[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
  std::vector<std::array<int, 4>> tets;
  for (int cell_id = 0; cell_id < n[0] * n[1] * n[2]; ++cell_id) {
    for (int w = 0; w < 6; ++w) {
      std::array<int, 3> at{cell_id % n[0], cell_id / n[0] % n[1], cell_id / n[0] / n[1]};
      std::array<int, 4> tet;
      tet[0] = number(at);
      for (int step = 0; step < 3; ++step) {
        ++at[ways[w][step]];
        tet[step + 1] = number(at);
      }
      if (w >= 3) std::swap(tet[2], tet[3]);
      tets.push_back(tet);
    }
  }
  return make_template(name, std::move(nodes), std::move(tets));
}

}  // namespace qdem::bed
