// Doubles that start on a cache line, so that no vector of eight lies on two of them.
#pragma once

#include <cstddef>
#include <vector>

#include "proto/span.hpp"

namespace qdem::cpu {

/// A fixed number of doubles, zero at first.
class AlignedValues {
 public:
  explicit AlignedValues(std::size_t n = 0) : lines_((n + per_line - 1) / per_line), size_(n) {}
  double* data() { return reinterpret_cast<double*>(lines_.data()); }
  const double* data() const { return reinterpret_cast<const double*>(lines_.data()); }
  std::size_t size() const { return size_; }
  double& operator[](std::size_t i) { return data()[i]; }
  double operator[](std::size_t i) const { return data()[i]; }
  operator proto::Span<double>() { return {data(), size_}; }

 private:
  static constexpr std::size_t per_line = 8;
  struct alignas(64) Line {
    double values[per_line] = {};
  };
  std::vector<Line> lines_;
  std::size_t size_;
};

}  // namespace qdem::cpu
