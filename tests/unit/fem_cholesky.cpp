// The solve on CHOLMOD's factor against Eigen's own Cholesky.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <vector>

#include "fem_solver/linear/cholesky.hpp"
#include "proto/error.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using tests::near_abs;

/// Lower triangle of the seven-point Laplacian on nx x ny x nz points, plus the identity.
Matrix laplacian(int nx, int ny, int nz) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto id = [&](int i, int j, int k) { return (i * ny + j) * nz + k; };
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (int k = 0; k < nz; ++k) {
        entries.emplace_back(id(i, j, k), id(i, j, k), 7.0);
        if (i > 0) entries.emplace_back(id(i, j, k), id(i - 1, j, k), -1.0);
        if (j > 0) entries.emplace_back(id(i, j, k), id(i, j - 1, k), -1.0);
        if (k > 0) entries.emplace_back(id(i, j, k), id(i, j, k - 1), -1.0);
      }
    }
  }
  Matrix lower(nx * ny * nz, nx * ny * nz);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

/// Small enough for one branch, and long as a rail is, large enough for two.
class Solve : public ::testing::TestWithParam<int> {};

TEST_P(Solve, EqualsEigensOwn) {
  const Matrix lower = laplacian(GetParam(), 9, 9);
  const fem::Cholesky cholesky(lower, "test");
  const Eigen::SimplicialLDLT<Matrix, Eigen::Lower> reference(lower);
  Eigen::MatrixXd right(lower.rows(), 3);
  for (Eigen::Index i = 0; i < right.size(); ++i) right.data()[i] = std::sin(0.7 * static_cast<double>(i));
  const Eigen::MatrixXd expected = reference.solve(right), found = cholesky.solve_columns(right);
  EXPECT_TRUE(near_abs((found - expected).norm() / expected.norm(), 0.0, 1e-13));
  const Eigen::VectorXd one = cholesky.solve(right.col(1));
  EXPECT_TRUE(near_abs((one - expected.col(1)).norm() / expected.col(1).norm(), 0.0, 1e-13));
  EXPECT_TRUE(one == cholesky.solve(right.col(1))) << "the same bits again";
}
INSTANTIATE_TEST_SUITE_P(OfLengths, Solve, ::testing::Values(2, 200));

TEST(Cholesky, RefusesAMatrixThatIsNotPositiveDefinite) {
  Matrix lower = laplacian(3, 3, 3);
  lower.coeffRef(5, 5) = -1.0;
  try {
    const fem::Cholesky cholesky(lower, "rail");
    FAIL() << "it was factorised";
  } catch (const proto::Error& error) {
    EXPECT_EQ(error.code(), proto::ExitCode::bad_data);
  }
}

}  // namespace
