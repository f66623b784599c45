#include "coupler/page/part.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "coupler/page/encode.hpp"

namespace coupler::page {
namespace {

constexpr std::size_t n_quantities = 7;  // of a body's history
const std::string displacement_name = "/VTKHDF/PointData/displacement", velocity_name = "/VTKHDF/PointData/velocity",
                  stress_name = "/VTKHDF/CellData/von_mises_stress";

}  // namespace

Part::Part(proto::ResultReader file, std::string kind)
    : file_(std::move(file)), kind_(std::move(kind)), mesh_(study::read_mesh(file_)), surface_(surface_of(mesh_)) {
  time_ = file_.read_rows("/VTKHDF/Steps/Values", file_.n_steps()).values;
  std::map<std::pair<bool, std::int64_t>, std::size_t> place;
  for (std::size_t b = 0; b < n_bodies(); ++b) place[{surface_.bodies[b].sleeper, surface_.bodies[b].number}] = b;
  cells_of_.resize(n_bodies());
  for (std::size_t cell = 0; cell < mesh_.n_cells(); ++cell) {
    const auto body = place.find({mesh_.sleeper[cell], mesh_.bodies[cell]});
    if (body != place.end()) cells_of_[body->second].push_back(static_cast<std::uint32_t>(cell));
  }
}

nlohmann::json Part::geometry() const {
  std::vector<double> points;
  points.reserve(3 * surface_.points.size());
  for (const auto point : surface_.points) {
    for (std::size_t c = 0; c < 3; ++c) points.push_back(mesh_.points[3 * point + c]);
  }
  auto bodies = nlohmann::json::array();
  for (const auto& body : surface_.bodies) {
    std::array<double, 3> centre{};
    for (std::size_t i = 3 * body.first_point; i < 3 * (body.first_point + body.n_points); ++i) {
      centre[i % 3] += points[i] / static_cast<double>(body.n_points);
    }
    bodies.push_back({{"number", body.number},
                      {"kind", body.sleeper ? "sleeper" : kind_},
                      {"points", {body.first_point, body.n_points}},
                      {"triangles", {body.first_triangle, body.n_triangles}},
                      {"centre", centre}});
  }
  return {{"bodies", bodies}, {"points", float_json(points)}, {"triangles", index_json(surface_.triangles)}};
}

std::vector<double> Part::at_step(const std::string& dataset, std::size_t step) const {
  const std::uint64_t n = dataset == stress_name ? mesh_.n_cells() : mesh_.n_points();
  if (file_.has(dataset)) return file_.read_rows(dataset, step * n, n).values;
  return std::vector<double>(dataset == stress_name ? n : 3 * n, std::nan(""));
}

std::vector<double> Part::point_stress(const std::vector<double>& cells) const {
  std::vector<double> result;
  result.reserve(surface_.points.size());
  std::vector<double> sum(mesh_.n_points(), 0.0), count(mesh_.n_points(), 0.0);
  for (std::size_t b = 0; b < n_bodies(); ++b) {
    const auto& body = surface_.bodies[b];
    for (std::size_t i = 0; i < body.n_points; ++i) {
      const auto point = surface_.points[body.first_point + i];
      sum[point] = count[point] = 0.0;
    }
    for (const auto cell : cells_of_[b]) {
      for (auto k = mesh_.offsets[cell]; k < mesh_.offsets[cell + 1]; ++k) {
        sum[mesh_.corners[k]] += cells[cell], count[mesh_.corners[k]] += 1.0;
      }
    }
    for (std::size_t i = 0; i < body.n_points; ++i) {
      const auto point = surface_.points[body.first_point + i];
      result.push_back(sum[point] / count[point]);
    }
  }
  return result;
}

nlohmann::json Part::frame(std::size_t step) const {
  const auto u = at_step(displacement_name, step), v = at_step(velocity_name, step);
  std::vector<double> displacement, speed;
  displacement.reserve(3 * surface_.points.size()), speed.reserve(surface_.points.size());
  for (const auto point : surface_.points) {
    displacement.insert(displacement.end(), &u[3 * point], &u[3 * point] + 3);
    speed.push_back(std::hypot(v[3 * point], v[3 * point + 1], v[3 * point + 2]));
  }
  return {{"displacement", quantised_json(displacement)},
          {"speed", quantised_json(speed)},
          {"stress", quantised_json(point_stress(at_step(stress_name, step)))}};
}

std::size_t Part::frame_length() const {
  return base64_length(2 * 5 * surface_.points.size());
}

std::size_t Part::history_length() const {
  return base64_length(2 * n_quantities * n_bodies());
}

nlohmann::json Part::histories(const std::vector<std::size_t>& steps) const {
  std::vector<std::array<std::vector<double>, n_quantities>> values(n_bodies());
  for (const auto step : steps) {
    const auto u = at_step(displacement_name, step), v = at_step(velocity_name, step), s = at_step(stress_name, step);
    for (std::size_t b = 0; b < n_bodies(); ++b) {
      const auto& body = surface_.bodies[b];
      std::array<double, n_quantities> now{};
      for (std::size_t i = 0; i < body.n_points; ++i) {
        const std::size_t point = surface_.points[body.first_point + i];
        for (std::size_t c = 0; c < 3; ++c) {
          now[c] += u[3 * point + c] / static_cast<double>(body.n_points);
          now[3 + c] += v[3 * point + c] / static_cast<double>(body.n_points);
        }
      }
      now[6] = s[cells_of_[b].front()];
      for (const auto cell : cells_of_[b]) now[6] = std::max(now[6], s[cell]);
      for (std::size_t q = 0; q < n_quantities; ++q) values[b][q].push_back(now[q]);
    }
  }
  auto result = nlohmann::json::array();
  for (const auto& body : values) {
    auto quantities = nlohmann::json::array();
    for (const auto& quantity : body) quantities.push_back(quantised_json(quantity));
    result.push_back(quantities);
  }
  return result;
}

std::vector<std::size_t> evenly_spaced(std::size_t n, std::size_t n_most) {
  std::vector<std::size_t> result;
  const std::size_t count = std::min(n, n_most);
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(count == 1 ? 0 : (i * (n - 1) + (count - 1) / 2) / (count - 1));
  }
  return result;
}

}  // namespace coupler::page
