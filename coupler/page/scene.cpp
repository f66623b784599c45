#include "coupler/page/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "coupler/page/part.hpp"

namespace coupler::page {
namespace {

constexpr std::size_t frame_overhead = 300;  // characters of a frame beside its numbers

/// The parts of a run that have at least one output.
std::vector<Part> open_parts(const std::string& folder) {
  std::vector<Part> parts;
  for (const auto& [name, kind] : {std::pair{"qdem.h5", "stone"}, std::pair{"fem.h5", "rail"}}) {
    const std::string path = folder + "/" + name;
    if (!std::filesystem::exists(path)) continue;
    proto::ResultReader file(path);
    if (file.n_steps() == 0) continue;
    Part part(std::move(file), kind);
    if (part.n_bodies() > 0) parts.push_back(std::move(part));
  }
  return parts;
}

std::size_t nearest(const std::vector<double>& time, double wanted) {
  const auto closer = [&](double a, double b) { return std::abs(a - wanted) < std::abs(b - wanted); };
  return static_cast<std::size_t>(std::min_element(time.begin(), time.end(), closer) - time.begin());
}

/// Of each time the nearest output of the part.
std::vector<std::size_t> nearest_steps(const Part& part, const std::vector<double>& times) {
  std::vector<std::size_t> steps;
  for (const double time : times) steps.push_back(nearest(part.time(), time));
  return steps;
}

std::vector<double> times_of(const Part& part, const std::vector<std::size_t>& steps) {
  std::vector<double> times;
  for (const auto step : steps) times.push_back(part.time()[step]);
  return times;
}

}  // namespace

nlohmann::json scene_json(const std::string& folder, std::size_t n_characters) {
  const auto parts = open_parts(folder);
  if (parts.empty()) return {{"note", "The run left no fields of bodies (qdem.h5, fem.h5)."}};
  const Part& leading = parts.front();
  std::size_t fixed = 0, per_frame = 0, per_history = 0;
  auto geometries = nlohmann::json::array();
  for (const auto& part : parts) {
    geometries.push_back(part.geometry());
    fixed += geometries.back().dump().size() + 150 * part.n_bodies();
    per_frame += part.frame_length() + frame_overhead;
    per_history += part.history_length();
  }
  const std::size_t free = n_characters > fixed ? n_characters - fixed : 0;
  const auto history_steps =
      evenly_spaced(leading.n_steps(), std::max<std::size_t>(2, free / 4 / std::max<std::size_t>(1, per_history)));
  const std::size_t for_histories = history_steps.size() * per_history + 600 * leading.n_bodies();
  const std::size_t n_frames = free > for_histories ? (free - for_histories) / per_frame : 0;
  if (n_frames < std::min<std::size_t>(2, leading.n_steps())) {
    return {{"note", fmt::format("The 3-D view is left out: a frame takes {:.1f} MB, and the page may have {:.1f} MB "
                                 "for all of them (--size-limit). The fields are in qdem.xdmf for ParaView.",
                                 static_cast<double>(per_frame) * 1e-6, static_cast<double>(free) * 1e-6)}};
  }
  const auto frame_times = times_of(leading, evenly_spaced(leading.n_steps(), n_frames));
  const auto history_times = times_of(leading, history_steps);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    auto frames = nlohmann::json::array();
    for (const auto step : nearest_steps(parts[p], frame_times)) frames.push_back(parts[p].frame(step));
    geometries[p]["frames"] = std::move(frames);
    geometries[p]["histories"] = parts[p].histories(nearest_steps(parts[p], history_times));
  }
  return {{"parts", std::move(geometries)},
          {"frames", frame_times},
          {"history_time", history_times},
          {"outputs", leading.n_steps()}};
}

}  // namespace coupler::page
