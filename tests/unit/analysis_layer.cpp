// Modes from decay, depth bins, attenuation and force chains against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "coupler/analysis/cycles.hpp"
#include "coupler/analysis/force_chains.hpp"
#include "coupler/analysis/layer.hpp"
#include "coupler/analysis/modes.hpp"
#include "coupler/analysis/statistics.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using namespace coupler::analysis;
using tests::near_abs;
using tests::near_rel;

/// Sum of damped oscillations, each with a phase of its own.
std::vector<double> decay(const std::vector<Mode>& modes, std::size_t n, double dt) {
  std::vector<double> x(n, 0.0);
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const double w = 2 * M_PI * modes[k].frequency, damped = w * std::sqrt(1 - modes[k].damping * modes[k].damping);
    for (std::size_t i = 0; i < n; ++i) {
      const double t = dt * static_cast<double>(i);
      x[i] += modes[k].amplitude * std::exp(-modes[k].damping * w * t) *
              std::cos(damped * t + 0.5 + static_cast<double>(k));
    }
  }
  return x;
}

TEST(LoadCycles, AreCountedThroughRipples) {
  constexpr int samples = 200;  // of a cycle
  std::vector<double> load;
  for (int i = 0; i < 5 * samples; ++i) {
    const double t = 2 * M_PI * i / samples;
    load.push_back(16.0 - 14.0 * std::cos(t) + 1.5 * std::sin(17 * t));  // begins unloaded
  }
  const auto cycles = load_cycles(load);
  ASSERT_EQ(cycles.size(), 5u);
  for (std::size_t k = 0; k < cycles.size(); ++k) {
    EXPECT_NEAR(static_cast<double>(cycles[k].peak), (static_cast<double>(k) + 0.5) * samples, 8);
    EXPECT_GT(cycles[k].trough, cycles[k].peak);
    EXPECT_LT(load[cycles[k].trough], 4.0);
  }
  load.resize(4 * samples + samples / 2);  // the last cycle stays up
  EXPECT_EQ(load_cycles(load).size(), 4u);
  EXPECT_TRUE(load_cycles(std::vector<double>(10, 3.0)).empty());
  EXPECT_TRUE(load_cycles(std::vector<double>{}).empty());
}

TEST(EigensystemRealisation, FindsCloseModesBelowTheFrequencyOfInterest) {
  const std::vector<Mode> modes = {{90.0, 0.05, 2.0}, {310.0, 0.03, 1.0}, {340.0, 0.02, 0.5}};
  const auto found = eigensystem_realisation(decay(modes, 2000, 1e-4), 1e-4, {1000.0, 12, 1e-9});
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_TRUE(near_rel(found[k].frequency, modes[k].frequency, 1e-6)) << k;
    EXPECT_TRUE(near_rel(found[k].damping, modes[k].damping, 1e-6)) << k;
    EXPECT_TRUE(near_rel(found[k].amplitude, modes[k].amplitude, 1e-5)) << k;
  }
}

TEST(EigensystemRealisation, StandsNoiseAndAnswersNothingForTooLittle) {
  auto x = decay({{90.0, 0.05, 2.0}, {310.0, 0.03, 1.0}}, 2000, 1e-4);
  unsigned noise = 1;
  for (double& value : x) noise = noise * 1664525u + 1013904223u, value += 0.02 * (noise / 2147483648.0 - 1);
  const auto found = eigensystem_realisation(x, 1e-4, {500.0, 8, 1e-2});
  ASSERT_GE(found.size(), 2u);
  EXPECT_TRUE(near_rel(found[0].frequency, 90.0, 0.01));
  EXPECT_TRUE(near_rel(found[0].damping, 0.05, 0.05));
  EXPECT_TRUE(near_rel(found[1].frequency, 310.0, 0.01));
  EXPECT_TRUE(near_rel(found[1].damping, 0.03, 0.1));
  EXPECT_TRUE(eigensystem_realisation(std::vector<double>(30, 1.0), 1e-4, {1000.0, 8, 1e-2}).empty());
  EXPECT_TRUE(eigensystem_realisation(std::vector<double>(2000, 0.0), 1e-4, {1000.0, 8, 1e-2}).empty());
}

TEST(Statistics, OfFewNumbers) {
  const auto s = statistics(std::vector<double>{1, 2, 6});
  EXPECT_DOUBLE_EQ(s.mean, 3.0);
  EXPECT_DOUBLE_EQ(s.deviation, std::sqrt(7.0));
  EXPECT_DOUBLE_EQ(s.largest, 6.0);
  EXPECT_TRUE(std::isnan(statistics(std::vector<double>{4}).deviation));
  EXPECT_TRUE(std::isnan(statistics(std::vector<double>{}).mean));
}

TEST(DecayLength, IsThatOfAnExponential) {
  std::vector<double> x, y;
  for (int i = 0; i < 5; ++i) x.push_back(0.05 * i), y.push_back(3 * std::exp(-x.back() / 0.12));
  EXPECT_TRUE(near_rel(decay_length(x, y), 0.12, 1e-12));
  EXPECT_TRUE(std::isnan(decay_length(x, std::vector<double>{1, 2, 3, 4, 5})));
  EXPECT_TRUE(std::isnan(decay_length(x, std::vector<double>(5, 0.0))));
}

const Footprint sleeper{-0.12, 0.12, 0.0, 1.0, -0.2};

TEST(Footprint, MeasuresDistances) {
  EXPECT_DOUBLE_EQ(sleeper.beside({0.0, 0.5, -0.4}), 0.0);
  EXPECT_DOUBLE_EQ(sleeper.beside({0.15, 1.04, -0.4}), 0.05);
  EXPECT_DOUBLE_EQ(sleeper.distance({0.15, 1.04, -0.32}), 0.13);
}

TEST(DepthBins, HoldTheStonesUnderTheSleeper) {
  const std::vector<std::array<double, 3>> places = {{0, 0.5, -0.25},  {0.1, 0.2, -0.34}, {0.0, 0.9, -0.60},
                                                     {0.2, 0.5, -0.3}, {0.0, 0.5, -0.1},  {0.0, 0.1, -0.41}};
  const auto bins = depth_bins(places, sleeper, 2, 0.0);
  ASSERT_EQ(bins.size(), 2u);
  EXPECT_DOUBLE_EQ(bins[0].top, 0.0);
  EXPECT_DOUBLE_EQ(bins[1].bottom, 0.4);
  EXPECT_EQ(bins[0].points, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(bins[1].points, (std::vector<std::size_t>{2, 5}));
  EXPECT_EQ(depth_bins(places, sleeper, 2, 0.09)[0].points, (std::vector<std::size_t>{0, 1, 3}));
  EXPECT_TRUE(depth_bins({{5, 5, -1}}, sleeper, 2, 0.0).empty());
}

TEST(Records, RmsAndPeak) {
  std::vector<double> x;
  for (int i = 0; i < 100; ++i) x.push_back(5 + 2 * std::sin(2 * M_PI * i / 100.0));
  EXPECT_TRUE(near_rel(rms(x), std::sqrt(2.0), 1e-12));
  EXPECT_DOUBLE_EQ(peak_change(x), 2.0);
}

TEST(ForceChains, FiguresOfAHandfulOfContacts) {
  const std::vector<PairContact> contacts = {{0, 1, 1.0}, {1, 2, 1.0}, {1, 3, 4.0}, {2, -1, 2.0}};
  const auto figures = chain_figures(contacts);
  EXPECT_EQ(figures.n_pairs, 4u);
  EXPECT_DOUBLE_EQ(figures.mean_force, 2.0);
  EXPECT_DOUBLE_EQ(figures.largest_force, 4.0);
  EXPECT_DOUBLE_EQ(coordination(contacts, {1, 2, 3}), 5.0 / 3);
  EXPECT_DOUBLE_EQ(figures.strong_share, 0.25);
  EXPECT_DOUBLE_EQ(figures.strong_force_share, 0.5);
  EXPECT_DOUBLE_EQ(figures.participation, 64.0 / (4 * 22));
  EXPECT_EQ(chain_figures({}).n_pairs, 0u);
}

TEST(ForceChains, DistributionAndLoss) {
  const std::vector<PairContact> before = {{0, 1, 1.0}, {1, 2, 1.0}, {1, 3, 4.0}, {2, -1, 2.0}};
  const std::vector<PairContact> after = {{0, 1, 3.0}, {2, -2, 2.0}, {2, 3, 1.0}};
  // Over the mean: 0.5, 0.5, 2, 1. Bins of 0.8 up to 2.4.
  const auto density = force_distribution(before, 2.4, 3);
  EXPECT_TRUE(near_rel(density[0], 0.5 / 0.8, 1e-12));
  EXPECT_TRUE(near_rel(density[1], 0.25 / 0.8, 1e-12));
  EXPECT_TRUE(near_rel(density[2], 0.25 / 0.8, 1e-12));
  EXPECT_DOUBLE_EQ(lost_share(before, after), 0.75);
  EXPECT_TRUE(std::isnan(lost_share({}, after)));
}

}  // namespace
