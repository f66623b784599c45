#include "qdem_solver/bed/forecast.hpp"

#include <algorithm>
#include <limits>

#include "qdem_solver/bed/drawn_stones.hpp"
#include "qdem_solver/engine/stability.hpp"

namespace qdem {
namespace {

// x, v, a, force, 1/m and the pads' reference; three components each.
constexpr double bytes_per_particle = 6 * 3 * sizeof(double);
// A candidate's key, slip, triangles, force, wake and places in lists; candidates a stone, measured in settled beds.
constexpr double bytes_per_candidate = 300, candidates_per_stone = 60;
// Program, libraries and the templates' meshes, measured.
constexpr double bytes_of_program = 60e6;

}  // namespace

BedForecast forecast_bed(const proto::CaseFile& file, const BedPhysics& physics) {
  const bed::Settings settings = bed::read_settings(file);
  bed::Random random(settings.seed, 1);
  bed::DrawnStones drawn = bed::draw_bed(settings, physics.contact.rounding, random);
  std::vector<bed::Stone> stones = std::move(drawn.layer);
  stones.insert(stones.end(), drawn.crib.begin(), drawn.crib.end());

  Model model;
  model.materials = physics.materials();
  model.templates = std::move(drawn.templates);
  for (const bed::Stone& stone : stones) {
    Body body;
    body.template_id = stone.template_id, body.material_id = stone.material_id;
    body.scale = stone.size - 2 * physics.contact.rounding;
    model.bodies.push_back(body);
  }
  make_batches(model);
  BedForecast forecast;
  forecast.stones = static_cast<std::int64_t>(stones.size());
  forecast.stone_step_bound = std::numeric_limits<double>::infinity();
  for (const Rates& rates : element_rates(model)) {
    forecast.stone_step_bound = std::min(forecast.stone_step_bound, largest_stable_step(rates));
  }
  if (stones.empty()) forecast.stone_step_bound = sleeper_figures(file, physics).step_bound;
  const Template sleeper = bed::sleeper_mesh("sleeper", settings.sleeper, settings.sleeper_cells);
  forecast.elements = model.n_elements() + sleeper.n_tets();
  forecast.particles = sleeper.n_nodes();
  for (const Body& body : model.bodies) forecast.particles += model.templates[body.template_id].n_nodes();
  forecast.memory_bytes = bytes_of_program + bytes_per_particle * static_cast<double>(forecast.particles) +
                          bytes_per_candidate * candidates_per_stone * static_cast<double>(forecast.stones);
  return forecast;
}

}  // namespace qdem
