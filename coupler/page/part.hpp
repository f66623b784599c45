// The fields of one result file on the surface of its bodies.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "coupler/page/surface.hpp"

namespace coupler::page {

/// One of qdem.h5 (sleepers, stones) and fem.h5 (rail), opened for the page.
class Part {
 public:
  /// `kind`: of the bodies that are no sleeper: "stone", "rail".
  Part(proto::ResultReader file, std::string kind);

  std::size_t n_steps() const { return time_.size(); }
  const std::vector<double>& time() const { return time_; }  ///< of the outputs [s]
  std::size_t n_bodies() const { return surface_.bodies.size(); }

  /// Bodies with their ranges and centres; points [n][3] float32 [m]; triangles uint32 [n][3].
  nlohmann::json geometry() const;

  /// Fields of one output at the points of the surface: `displacement` [n][3] [m], `speed` [n] [m/s], `stress` [n] [Pa]
  /// (von Mises, mean of the cells of the body around the point), quantised with a step of their own.
  nlohmann::json frame(std::size_t step) const;
  /// Characters of a frame, within 200.
  std::size_t frame_length() const;

  /// What a pick shows, per body [steps][7] quantised per quantity: displacement x, y, z [m] and velocity x, y, z
  /// [m/s], means over the points of the body's surface, and the largest von Mises stress of its cells [Pa].
  nlohmann::json histories(const std::vector<std::size_t>& steps) const;
  /// Characters of the histories, per step.
  std::size_t history_length() const;

 private:
  std::vector<double> at_step(const std::string& dataset, std::size_t step) const;
  std::vector<double> point_stress(const std::vector<double>& cells) const;

  proto::ResultReader file_;
  std::string kind_;
  study::Mesh mesh_;
  Surface surface_;
  std::vector<double> time_;
  std::vector<std::vector<std::uint32_t>> cells_of_;  ///< [bodies]
};

/// At most `n_most` (>= 1) of the numbers 0..n-1, evenly spaced, with the first and the last.
std::vector<std::size_t> evenly_spaced(std::size_t n, std::size_t n_most);

}  // namespace coupler::page
