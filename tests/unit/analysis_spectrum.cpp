// Spectra against closed forms and against scipy's Welch on stored vectors.
#include "coupler/analysis/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <random>

#include "coupler/analysis/transfer.hpp"
#include "tests/support/tolerance.hpp"

namespace {

using namespace coupler::analysis;
using tests::near_abs;
using tests::near_rel;

std::vector<double> sampled(std::size_t n, double dt, double (*f)(double)) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = f(dt * static_cast<double>(i));
  return x;
}

TEST(Transform, IsTheSumItStandsFor) {
  std::mt19937 generator(3);
  for (const std::size_t n : {2u, 12u, 13u, 30u, 97u}) {
    std::vector<double> x(n);
    for (double& value : x) value = static_cast<double>(generator()) / 4e9;
    const auto lines = transform(x);
    ASSERT_EQ(lines.size(), n / 2 + 1);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      std::complex<double> sum = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        sum += x[i] * std::polar(1.0, -2 * M_PI * static_cast<double>(i * k) / static_cast<double>(n));
      }
      EXPECT_LT(std::abs(lines[k] - sum), 1e-12 * static_cast<double>(n)) << n << " " << k;
    }
  }
}

TEST(AmplitudeSpectrum, ShowsAHarmonicAtItsAmplitude) {
  const double dt = 1e-3;
  const auto x = sampled(200, dt, [](double t) {
    return 0.25 + 3 * std::cos(2 * M_PI * 45 * t + 0.3) + 0.5 * std::cos(2 * M_PI * 500 * t);
  });
  const auto amplitudes = amplitude_spectrum(x);
  const auto f = frequencies(200, dt);
  for (std::size_t k = 0; k < f.size(); ++k) {
    const double expected = k == 0 ? 0.25 : k == 9 ? 3.0 : k == 100 ? 0.5 : 0.0;
    EXPECT_TRUE(near_abs(amplitudes[k], expected, 1e-12)) << f[k] << " Hz";
  }
  EXPECT_DOUBLE_EQ(f[9], 45.0);
}

TEST(PowerDensity, SumsUpToTheVarianceAndPeaksAsAToneShould) {
  const double dt = 1e-3;
  const auto x = sampled(1000, dt, [](double t) { return 7 + 3 * std::cos(2 * M_PI * 50 * t); });
  const Segmentation halves{200, 100, Window::hann};
  EXPECT_EQ(n_segments(x.size(), halves), 9u);
  const auto spectra = segment_transforms(x, dt, halves);
  const auto density = power_density(spectra);
  double sum = 0.0;
  for (const double value : density) sum += value * spectra.frequency[1];
  EXPECT_TRUE(near_rel(sum, 4.5, 1e-12));
  // A tone of variance s^2 on a line: s^2 / (1.5 resolution), 1.5 lines being the noise bandwidth of the Hann window.
  EXPECT_TRUE(near_rel(density[10], 4.5 / (1.5 * 5.0), 1e-12));
}

/// The arrays that tests/support/vectors/welch_vectors.py wrote.
std::map<std::string, std::vector<double>> stored_vectors() {
  std::ifstream file(HOUSE_SOURCE_DIR "/tests/support/vectors/welch.txt");
  std::map<std::string, std::vector<double>> vectors;
  std::string name;
  std::getline(file, name);
  for (std::size_t n = 0; file >> name >> n;) {
    auto& values = vectors[name];
    values.resize(n);
    for (double& value : values) file >> value;
  }
  return vectors;
}

/// Largest difference over the largest magnitude.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return INFINITY;
  double largest = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return largest / size;
}

TEST(PowerDensity, EqualsScipysWelch) {
  auto vectors = stored_vectors();
  ASSERT_EQ(vectors["x"].size(), 1000u);
  const std::pair<std::string, Segmentation> cuts[] = {{"hann_256_128", {256, 128, Window::hann}},
                                                       {"boxcar_250_0", {250, 0, Window::boxcar}},
                                                       {"hann_255_100", {255, 100, Window::hann}}};
  for (const auto& [name, cut] : cuts) {
    const auto x = segment_transforms(vectors["x"], 2.5e-4, cut), y = segment_transforms(vectors["y"], 2.5e-4, cut);
    EXPECT_LT(difference(x.frequency, vectors[name + "_frequency"]), 1e-12) << name;
    EXPECT_LT(difference(power_density(x), vectors[name + "_density"]), 1e-10) << name;
    std::vector<double> real, imaginary;
    for (const auto& value : cross_density(x, y)) real.push_back(value.real()), imaginary.push_back(value.imag());
    EXPECT_LT(difference(real, vectors[name + "_cross_real"]), 1e-10) << name;
    EXPECT_LT(difference(imaginary, vectors[name + "_cross_imaginary"]), 1e-10) << name;
    const auto density = power_density(x);
    for (std::size_t k = 1; k < density.size(); ++k) {  // line 0 is round-off without a window: the mean was removed
      EXPECT_TRUE(near_rel(density[k], vectors[name + "_density"][k], 1e-8)) << name << " line " << k;
    }
  }
}

/// Two masses in a row on springs and dashpots, shaken at the base.
class Chain {
 public:
  static constexpr double m = 1.0, k1 = 4e5, k2 = 1.5e5, c1 = 120.0, c2 = 60.0;

  /// |X_2 / Y| of steady vibration.
  static double transmissibility(double f) {
    const std::complex<double> iw(0, 2 * M_PI * f), s1 = k1 + iw * c1, s2 = k2 + iw * c2, a = m * iw * iw;
    return std::abs(s1 * s2 / ((a + s1 + s2) * (a + s2) - s2 * s2));
  }
  /// One step of dt by the classical Runge-Kutta method; base(t) gives position and velocity.
  template <class Base>
  void step(double t, double dt, Base base) {
    const auto rate = [&](double time, const std::array<double, 4>& q) {
      const auto [y, v] = base(time);
      const double f1 = k1 * (y - q[0]) + c1 * (v - q[1]), f2 = k2 * (q[0] - q[2]) + c2 * (q[1] - q[3]);
      return std::array<double, 4>{q[1], (f1 - f2) / m, q[3], f2 / m};
    };
    const auto moved = [&](const std::array<double, 4>& r, double h) {
      auto result = q_;
      for (int i = 0; i < 4; ++i) result[i] += h * r[i];
      return result;
    };
    const auto r1 = rate(t, q_), r2 = rate(t + dt / 2, moved(r1, dt / 2)), r3 = rate(t + dt / 2, moved(r2, dt / 2)),
               r4 = rate(t + dt, moved(r3, dt));
    for (int i = 0; i < 4; ++i) q_[i] += dt / 6 * (r1[i] + 2 * r2[i] + 2 * r3[i] + r4[i]);
  }
  double velocity() const { return q_[3]; }

 private:
  std::array<double, 4> q_{};
};

TEST(Transfer, IsTheTransmissibilityOfTwoMasses) {
  const double dt = 1e-4;
  const std::size_t n = 2000;  // 5 Hz lines
  const auto base = [](double t) {
    double y = 0, v = 0;
    for (int k = 1; k <= 60; ++k) {
      const double w = 2 * M_PI * 5 * k, phase = 0.7 * k * k;
      y += std::sin(w * t + phase) / w, v += std::cos(w * t + phase);
    }
    return std::make_pair(y, v);
  };
  Chain chain;
  std::vector<double> input, output;
  const std::size_t settling = 3 * n;
  for (std::size_t i = 0; i < settling + 2 * n; ++i) {
    const double t = dt * static_cast<double>(i);
    if (i >= settling) input.push_back(base(t).second), output.push_back(chain.velocity());
    chain.step(t, dt, base);
  }
  const Segmentation cut{n, n / 2, Window::boxcar};
  const BottomReference reference({segment_transforms(input, dt, cut)});
  const auto response = reference.response(segment_transforms(output, dt, cut), 0);
  for (std::size_t k = 1; k <= 60; ++k) {
    const double f = reference.frequency()[k];
    EXPECT_TRUE(near_rel(response.magnitude[k], Chain::transmissibility(f), 1e-4)) << f << " Hz";
    EXPECT_TRUE(near_abs(response.coherence[k], 1.0, 1e-6)) << f << " Hz";
  }
  EXPECT_GT(Chain::transmissibility(45), 10 * Chain::transmissibility(300)) << "the chain tells frequencies apart";
}

TEST(Transfer, DoesNotVanishWhereTheBottomsMeanDoes) {
  const double dt = 1e-3;
  const Segmentation cut{200, 0, Window::boxcar};
  const auto tone = sampled(200, dt, [](double t) { return std::cos(2 * M_PI * 50 * t); });
  std::vector<double> opposite, half;
  for (const double value : tone) opposite.push_back(-value), half.push_back(0.5 * value);
  const BottomReference bending({segment_transforms(tone, dt, cut), segment_transforms(opposite, dt, cut)});
  EXPECT_TRUE(near_rel(bending.response(segment_transforms(half, dt, cut), 0).magnitude[10], 0.5, 1e-12));
}

TEST(Transfer, CoherenceFallsToTheShareThatFollows) {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  std::vector<double> x(200000), y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = normal(generator), y[i] = x[i] + normal(generator);
  const Segmentation cut{100, 50, Window::hann};
  const BottomReference reference({segment_transforms(x, 1e-3, cut)});
  const auto response = reference.response(segment_transforms(y, 1e-3, cut), 0);
  EXPECT_TRUE(near_rel(band_mean(reference.frequency(), response.coherence, 50, 450), 0.5, 0.02));
  EXPECT_TRUE(near_rel(band_mean(reference.frequency(), response.magnitude, 50, 450), std::sqrt(2.0), 0.01));
  EXPECT_TRUE(std::isnan(band_mean(reference.frequency(), response.magnitude, 11, 12)));
}

}  // namespace
