#include "coupler/analysis/spectrum.hpp"

#include <cmath>
#include <numeric>
#include <unsupported/Eigen/FFT>

namespace coupler::analysis {
namespace {

/// Factor of 2 that takes a two-sided line to a one-sided one: none for lines that are their own mirror image.
double one_sided(std::size_t line, std::size_t n_samples) {
  return line == 0 || 2 * line == n_samples ? 1.0 : 2.0;
}

std::vector<double> window_values(const Segmentation& segmentation) {
  const std::size_t n = segmentation.length;
  std::vector<double> values(n, 1.0);
  if (segmentation.window == Window::boxcar) return values;
  for (std::size_t i = 0; i < n; ++i) {
    values[i] = 0.5 * (1 - std::cos(2 * M_PI * static_cast<double>(i) / static_cast<double>(n)));
  }
  return values;
}

}  // namespace

std::vector<std::complex<double>> transform(proto::Span<const double> x) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> result;
  fft.fwd(result, std::vector<double>(x.begin(), x.end()));
  return result;
}

std::vector<double> frequencies(std::size_t n_samples, double dt) {
  std::vector<double> result(n_samples / 2 + 1);
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = static_cast<double>(k) / (static_cast<double>(n_samples) * dt);
  }
  return result;
}

std::vector<double> amplitude_spectrum(proto::Span<const double> x) {
  const auto lines = transform(x);
  std::vector<double> result(lines.size());
  for (std::size_t k = 0; k < lines.size(); ++k) {
    result[k] = one_sided(k, x.size()) * std::abs(lines[k]) / static_cast<double>(x.size());
  }
  return result;
}

std::size_t n_segments(std::size_t n_samples, const Segmentation& segmentation) {
  if (n_samples < segmentation.length) return 0;
  return 1 + (n_samples - segmentation.length) / (segmentation.length - segmentation.overlap);
}

SegmentTransforms segment_transforms(proto::Span<const double> x, double dt, const Segmentation& segmentation) {
  const std::size_t n = segmentation.length;
  const auto window = window_values(segmentation);
  const double power = std::inner_product(window.begin(), window.end(), window.begin(), 0.0);
  SegmentTransforms result;
  result.frequency = frequencies(n, dt);
  for (std::size_t k = 0; k < result.frequency.size(); ++k) result.weight.push_back(one_sided(k, n) * dt / power);
  std::vector<double> segment(n);
  for (std::size_t s = 0; s < n_segments(x.size(), segmentation); ++s) {
    const double* first = x.data() + s * (n - segmentation.overlap);
    const double mean = std::accumulate(first, first + n, 0.0) / static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) segment[i] = window[i] * (first[i] - mean);
    result.of.push_back(transform(segment));
  }
  return result;
}

std::vector<double> power_density(const SegmentTransforms& x) {
  std::vector<double> result;
  for (const auto& value : cross_density(x, x)) result.push_back(value.real());
  return result;
}

std::vector<std::complex<double>> cross_density(const SegmentTransforms& x, const SegmentTransforms& y) {
  std::vector<std::complex<double>> result(x.frequency.size(), 0.0);
  for (std::size_t s = 0; s < x.of.size(); ++s) {
    for (std::size_t k = 0; k < result.size(); ++k) result[k] += std::conj(x.of[s][k]) * y.of[s][k];
  }
  for (std::size_t k = 0; k < result.size(); ++k) result[k] *= x.weight[k] / static_cast<double>(x.of.size());
  return result;
}

}  // namespace coupler::analysis
