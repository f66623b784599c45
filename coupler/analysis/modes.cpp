#include "coupler/analysis/modes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>

namespace coupler::analysis {
namespace {

using Complex = std::complex<double>;
using Eigen::MatrixXd;

constexpr Eigen::Index largest_rows = 200;  // of the Hankel matrix
constexpr std::size_t fewest_blocks = 16;

std::vector<double> block_means(proto::Span<const double> x, std::size_t block) {
  std::vector<double> result(x.size() / block, 0.0);
  for (std::size_t i = 0; i < result.size(); ++i) {
    for (std::size_t k = 0; k < block; ++k) result[i] += x[i * block + k] / static_cast<double>(block);
  }
  return result;
}

/// What the mean over the first block makes of a term exp(pole t): a factor.
Complex block_factor(Complex pole, double dt, std::size_t block) {
  Complex sum = 0.0;
  for (std::size_t k = 0; k < block; ++k) sum += std::exp(pole * (dt * static_cast<double>(k)));
  return sum / static_cast<double>(block);
}

/// Eigenvalues of the realised system: exp(pole x step).
Eigen::VectorXcd realised_eigenvalues(const std::vector<double>& y, const RealisationOptions& options) {
  const auto n = static_cast<Eigen::Index>(y.size());
  const Eigen::Index rows = std::min(largest_rows, (n - 1) / 2), columns = n - rows;
  MatrixXd hankel(rows, columns), shifted(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      hankel(i, j) = y[static_cast<std::size_t>(i + j)];
      shifted(i, j) = y[static_cast<std::size_t>(i + j + 1)];
    }
  }
  const Eigen::BDCSVD<MatrixXd> svd(hankel, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const auto& values = svd.singularValues();
  Eigen::Index order = 0;
  const auto limit = std::min<Eigen::Index>(static_cast<Eigen::Index>(options.largest_order), values.size());
  while (order < limit && values[order] > options.tolerance * values[0]) ++order;
  if (order == 0) return {};
  const Eigen::VectorXd scale = values.head(order).cwiseSqrt().cwiseInverse();
  const MatrixXd system = scale.asDiagonal() * svd.matrixU().leftCols(order).transpose() * shifted *
                          svd.matrixV().leftCols(order) * scale.asDiagonal();
  return Eigen::EigenSolver<MatrixXd>(system, false).eigenvalues();
}

/// Weights c of y_n = sum_k c_k lambda_k^n, by least squares.
Eigen::VectorXcd weights_of(const Eigen::VectorXcd& eigenvalues, const std::vector<double>& y) {
  const auto n = static_cast<Eigen::Index>(y.size());
  Eigen::MatrixXcd powers(n, eigenvalues.size());
  Eigen::VectorXcd right(n);
  Eigen::VectorXcd power = Eigen::VectorXcd::Ones(eigenvalues.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    powers.row(i) = power.transpose();
    right[i] = y[static_cast<std::size_t>(i)];
    power = power.cwiseProduct(eigenvalues);
  }
  return powers.colPivHouseholderQr().solve(right);
}

}  // namespace

std::vector<Mode> eigensystem_realisation(proto::Span<const double> decay, double dt,
                                          const RealisationOptions& options) {
  const double blocks = 1 / (2.5 * options.highest_frequency * dt);
  const auto block = static_cast<std::size_t>(std::max(1.0, std::floor(blocks)));
  const auto y = block_means(decay, block);
  if (y.size() < fewest_blocks) return {};
  const auto eigenvalues = realised_eigenvalues(y, options);
  if (eigenvalues.size() == 0) return {};
  const auto weights = weights_of(eigenvalues, y);
  std::vector<Mode> modes;
  for (Eigen::Index k = 0; k < eigenvalues.size(); ++k) {
    const Complex pole = std::log(eigenvalues[k]) / (dt * static_cast<double>(block));
    const double frequency = std::abs(pole) / (2 * M_PI);
    // A pair of conjugates is one mode; what grows, or does not swing, is none.
    if (!(pole.imag() > 1e-6 * std::abs(pole)) || !(pole.real() < 0) || frequency > options.highest_frequency) continue;
    const double amplitude = 2 * std::abs(weights[k] / block_factor(pole, dt, block));
    modes.push_back({frequency, -pole.real() / std::abs(pole), amplitude});
  }
  std::sort(modes.begin(), modes.end(), [](const Mode& p, const Mode& q) { return p.amplitude > q.amplitude; });
  return modes;
}

}  // namespace coupler::analysis
