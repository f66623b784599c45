#include "qdem_solver/bench/machine_rates.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include "proto/clock.hpp"

namespace qdem::bench {
namespace {

typedef double Vector __attribute__((vector_size(64)));
constexpr int n_accumulators = 12;  // hides the latency of four cycles on two units
constexpr int rounds = 5;

using proto::seconds_since;

#if defined(__x86_64__)
__attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#endif
double
multiply_add(std::int64_t n, double factor, double addend) {
  Vector sums[n_accumulators];
  for (int i = 0; i < n_accumulators; ++i) sums[i] = Vector{} + 1.0 / (1 + i);
  for (std::int64_t k = 0; k < n; ++k) {
    for (int i = 0; i < n_accumulators; ++i) sums[i] = sums[i] * factor + addend;
  }
  double total = 0.0;
  for (int i = 0; i < n_accumulators; ++i) {
    for (int lane = 0; lane < 8; ++lane) total += sums[i][lane];
  }
  return total;
}

constexpr double flops_of_a_loop = 2.0 * 8 * n_accumulators;

double flop_rate(int threads) {
  constexpr std::int64_t n = 4'000'000;
  double best = 0.0;
  volatile double sink = 0.0;
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    double total = 0.0;
#pragma omp parallel num_threads(threads) reduction(+ : total)
    total += multiply_add(n, 0.999, 1e-3);
    sink = total;
    best = std::max(best, flops_of_a_loop * n * threads / seconds_since(start));
  }
  static_cast<void>(sink);
  return best;
}

double triad_rate(int threads) {
  const std::int64_t n = 1 << 25;
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  double best = 0.0;
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t i = 0; i < n; ++i) a[i] = b[i] + 0.5 * round * c[i];
    best = std::max(best, 24.0 * static_cast<double>(n) / seconds_since(start));
  }
  return best;
}

}  // namespace

MachineRates machine_rates(int threads) {
  return {flop_rate(threads), triad_rate(threads)};
}

double core_flop_rate() {
  constexpr std::int64_t n = 150'000;
  const auto start = std::chrono::steady_clock::now();
  volatile double sink = multiply_add(n, 0.999, 1e-3);
  static_cast<void>(sink);
  return flops_of_a_loop * n / seconds_since(start);
}

}  // namespace qdem::bench
