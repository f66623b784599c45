// V6: bending of a free sleeper under refinement. Constant-strain elements are too stiff in bending, by an error that
// falls with the square of their size.
#include <gtest/gtest.h>

#include "tests/support/box_mesh.hpp"
#include "tests/support/free_modes.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Eigen::Vector3d;
using tests::near_rel;

const Vector3d sleeper(2.0, 0.24, 0.17);

/// Frequencies [Hz] of the assembled linear elements with lumped masses, six a brick, by an eigen-solver that shares no
/// code with the solver: first modes across z and across y, by number of bricks through the thickness.
struct Row {
  int n;
  double vertical, horizontal;
};
constexpr Row table[] = {{2, 230.3, 284.3}, {3, 203.3, 264.1}, {4, 191.6, 251.9}, {6, 182.2, 246.3}, {8, 178.8, 243.6}};
constexpr double timoshenko = 174.0;  // [Hz] exact first bending mode of the free Timoshenko beam

std::array<int, 3> bricks(int n) {
  const double pitch = sleeper[2] / n;
  return {static_cast<int>(std::lround(sleeper[0] / pitch)), static_cast<int>(std::lround(sleeper[1] / pitch)), n};
}

/// Frequencies [Hz] of the two lowest modes, integrated in time: zero crossings at 1/4 and 5/4 of a period.
Row integrated(int n) {
  const auto model = tests::free_bodies(tests::box_template(bricks(n), sleeper), tests::concrete());
  const auto modes = tests::free_modes(model.shape(0), model.materials[0], 2, timoshenko);
  std::array<double, 2> found;
  for (int m = 0; m < 2; ++m) {
    found[m] = tests::frequency(tests::vibration(model, modes[m].shape, 1.3 / modes[m].frequency, 0.9));
  }
  std::cout << n << " through the thickness, " << model.shape(0).n_tets() << " elements: " << found[0]
            << " Hz vertical, " << found[1] << " Hz horizontal\n";
  return {n, found[0], found[1]};
}

}  // namespace

TEST(V6, BendingConvergesToTimoshenko) {
  std::vector<double> sizes, errors, found;
  for (const Row& row : table) {
    const Row result = integrated(row.n);
    EXPECT_TRUE(near_rel(result.vertical, row.vertical, 0.01));
    EXPECT_TRUE(near_rel(result.horizontal, row.horizontal, 0.01));
    found.push_back(result.vertical);
    if (row.n < 4) continue;  // errors of 17 % and more follow no power yet
    sizes.push_back(1.0 / row.n), errors.push_back(result.vertical - timoshenko);
  }
  const double finest = found.back(), finer = found[found.size() - 2];
  const double limit = finest + (finest - finer) / (std::pow(sizes[sizes.size() - 2] / sizes.back(), 2) - 1);
  std::cout << "extrapolated " << limit << " Hz, order " << tests::fitted_order(sizes, errors) << "\n";
  EXPECT_TRUE(near_rel(limit, timoshenko, 0.01));
  EXPECT_TRUE(tests::converges_with_order(sizes, errors, 2.0, 0.2));
}
