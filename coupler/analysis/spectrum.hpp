// Spectra of evenly sampled records.
#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "proto/span.hpp"

namespace coupler::analysis {

/// X_k = sum_n x_n exp(-2 pi i k n / N) for k = 0 .. N/2. Any length from 2 on; one with a large prime factor is slow.
std::vector<std::complex<double>> transform(proto::Span<const double> x);

/// k / (N dt) for k = 0 .. N/2 [Hz]; dt: sampling interval [s].
std::vector<double> frequencies(std::size_t n_samples, double dt);

/// Amplitude of each harmonic of the whole record, no window: 2 |X_k| / N, without the 2 at 0 and at N/2 [unit of x].
std::vector<double> amplitude_spectrum(proto::Span<const double> x);

enum class Window { boxcar, hann };  ///< hann: periodic, w_n = (1 - cos(2 pi n / N)) / 2

/// How a record is cut.
struct Segmentation {
  std::size_t length = 0;   ///< samples of a segment
  std::size_t overlap = 0;  ///< samples that neighbours share, below `length`
  Window window = Window::hann;
};

/// Number of segments that a record of `n_samples` holds.
std::size_t n_segments(std::size_t n_samples, const Segmentation& segmentation);

/// Transforms of a record's segments, from which densities follow. What is left over at the record's end is not used.
struct SegmentTransforms {
  std::vector<double> frequency;                      ///< [Hz]
  std::vector<double> weight;                         ///< density = weight x mean |transform|^2, per line [s]
  std::vector<std::vector<std::complex<double>>> of;  ///< [segment][line]; mean removed, window applied
};

/// Welch's segments (IEEE Trans. Audio Electroacoust. 15, 1967, 70-73), each without its mean.
/// Pre: the record holds a segment; dt > 0.
SegmentTransforms segment_transforms(proto::Span<const double> x, double dt, const Segmentation& segmentation);

/// One-sided power spectral density, mean over the segments [unit^2/Hz]: its sum times the resolution is the variance.
std::vector<double> power_density(const SegmentTransforms& x);

/// One-sided cross spectral density S_xy, mean of conj(X) Y [unit_x unit_y/Hz]. Both cut alike.
std::vector<std::complex<double>> cross_density(const SegmentTransforms& x, const SegmentTransforms& y);

}  // namespace coupler::analysis
