// What the mesh of qdem.h5 tells about sleeper and stones.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "coupler/analysis/layer.hpp"
#include "proto/result/reader.hpp"

namespace coupler::study {

/// Box of the sleeper's particles at the start; z is its lowest point. Nothing where there is no sleeper.
std::optional<analysis::Footprint> sleeper_box(const proto::ResultReader& qdem);

/// The stones of qdem.h5, for what is known at the outputs only.
class StoneMesh {
 public:
  explicit StoneMesh(const proto::ResultReader& qdem);

  std::size_t n_stones() const { return places_.size(); }
  /// Centres of mass at the start, stones in order of their numbers [m].
  const std::vector<std::array<double, 3>>& places() const { return places_; }
  /// Displacement [n_stones][3] of the centres at an output, from /VTKHDF/PointData/displacement [m].
  std::vector<double> displacement(const proto::ResultReader& qdem, std::uint64_t step) const;
  /// Largest von Mises stress in a stone at an output [Pa].
  double largest_stress(const proto::ResultReader& qdem, std::uint64_t step) const;
  /// Mean over the stones' tetrahedra of the edge of a regular one of the same volume [m].
  double element_size() const { return element_size_; }

 private:
  std::vector<double> centres(const std::vector<double>& values) const;

  std::vector<bool> in_stone_;          ///< [cells]
  std::vector<std::int64_t> stone_of_;  ///< [points]; -1: not in a stone
  std::vector<double> share_;           ///< [points] of the stone's mass
  std::vector<std::array<double, 3>> places_;
  double element_size_ = 0.0;
};

}  // namespace coupler::study
