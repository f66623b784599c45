#include "qdem_solver/bench/report.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "qdem_solver/bench/counted.hpp"
#include "qdem_solver/bench/machine_rates.hpp"
#include "qdem_solver/bench/rates.hpp"
#include "qdem_solver/engine/cpu/tasks.hpp"

namespace qdem::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int small = 200'000, large = 2'000'000;
constexpr int short_rounds = 200, long_rounds = 20;  // of scenes with a small and a large number of elements
constexpr double typical_speed = 0.1;                // of stones under traffic [m/s]: how long a candidate list lives

Work element_work() {
  const QuadrupleForce<Counted> force{Counted(1.0), Counted(1.0), {1, 1, 1, 1}};
  Counted dx[9], dv[9], g[9], f[9];
  Counted::work() = {};
  force(dx, dv, g, Counted(1.0), f);
  return Counted::work();
}

/// Element updates a second on one core.
struct ElementRate {
  double wall, cpu;       ///< see Rate
  double share_of_bound;  ///< of the first in what the core's multiply-adds allow, measured in turn with them
};

ElementRate element_rate(Scene scene, const Work& work, int n_rounds) {
  const auto n = static_cast<double>(scene.model.n_elements());
  const Rate rate = step_rate(scene, n_rounds);
  return {n * rate.wall, n * rate.cpu, n * rate.wall * static_cast<double>(work.instructions) / (rate.flops / 2)};
}

/// Bytes that a step moves through memory for an element, if nothing stays in cache between two steps: of a particle's
/// x, v, a and force every value read and written and 1/m read; of an element that stands alone its particles,
/// gradients and volume, and the forces of its block written and read.
double bytes_per_element(const Scene& scene) {
  constexpr double value = sizeof(double), particle = 3 * (2 * 4 + 1) * value;
  constexpr double own = 4 * sizeof(std::uint16_t) + (9 + 1) * value;
  const auto n = static_cast<double>(scene.model.n_elements());
  const bool shared = scene.model.bodies.size() > scene.model.templates.size();
  const auto slots = static_cast<double>(cpu::make_tasks(scene.model).n_slot_values);
  return (particle * static_cast<double>(scene.model.n_values) / 3 + 2 * value * slots) / n + (shared ? 0.0 : own);
}

void add_elements(Json& report, const MachineRates& core, const Work& work) {
  const Scene mesh = single_mesh(large), many = stones(large);
  const ElementRate general = element_rate(single_mesh(small), work, short_rounds);
  const ElementRate lanes = element_rate(stones(small), work, short_rounds);
  const ElementRate general_large = element_rate(mesh, work, long_rounds);
  const ElementRate lanes_large = element_rate(many, work, long_rounds);
  const double own_shape_bytes = bytes_per_element(mesh), template_bytes = bytes_per_element(many);
  report["bytes_per_element"] = {{"template", template_bytes}, {"own_shape", own_shape_bytes}};
  report["fp_bound_elements_per_s_core"] = general.wall / general.share_of_bound;
  report["general_elements_per_s_core"] = general.wall;
  report["template_elements_per_s_core"] = lanes.wall;
  report["general_fraction_of_fp_bound"] = general.share_of_bound;
  report["template_fraction_of_fp_bound"] = lanes.share_of_bound;
  report["general_fraction_of_bandwidth"] = general_large.cpu * own_shape_bytes / core.triad;
  report["template_fraction_of_bandwidth"] = lanes_large.cpu * template_bytes / core.triad;
  report["rate_2m_over_200k"] = lanes_large.cpu / lanes.cpu;
  report["general_rate_2m_over_200k"] = general_large.cpu / general.cpu;
}

void add_threads(Json& report) {
  constexpr int threads = 2;
  Scene scene = stones(small);
  report["bitwise_equal"] = same_bits(scene, threads, 20);
  report["two_thread_speedup"] = two_thread_speedup(scene);
}

/// Costs of contact: whole steps on `scene` beside its parts at their rates in `report`.
void add_contact(Json& report, Scene scene, const std::string& name) {
  const double pair_rate = report["contact_pairs_per_s_core"];
  const ContactCost cost = contact_cost(scene);
  const double dt = 0.8 * stable_step(scene);
  const double step = 1 / step_rate(scene, short_rounds).wall;
  const double parts =
      static_cast<double>(scene.model.n_elements()) / report["template_elements_per_s_core"].get<double>() +
      static_cast<double>(cost.live) / pair_rate;
  const double skin = scene.model.contact.skin > 0 ? scene.model.contact.skin : scene.model.contact.rounding;
  const double list_life = skin / 2 / (typical_speed * dt);  // steps
  const auto n_bodies = static_cast<double>(scene.model.bodies.size());
  report["whole_step_scene"] = name;
  report["whole_step_s_core"] = step;
  report["whole_step_over_parts"] = step / parts;
  report["broad_phase_share"] = cost.candidates_time_s / (cost.candidates_time_s + list_life * step);
  report["stone_steps_per_s_core"] = n_bodies / step;
  report["tetrahedra_per_stone"] = static_cast<double>(scene.model.n_elements()) / n_bodies;
  report["live_pairs_per_stone"] = static_cast<double>(cost.live) / n_bodies;
}

}  // namespace

Json measure(const Scene* settled) {
  const MachineRates core = machine_rates(1), pair = machine_rates(2);
  const Work work = element_work();
  Json report;
  report["instruction_set"] = cpu::kernels().instruction_set;
  report["fma_flops_per_s"] = {core.flops, pair.flops};
  report["triad_bytes_per_s"] = {core.triad, pair.triad};
  report["fp_instructions_per_element"] = work.instructions;
  report["flops_per_element"] = work.flops;
  // Before the scenes of millions of elements: the pile should lie in memory as in a run of its own.
  report["contact_pairs_per_s_core"] = contact_cost(pile()).pairs_per_s;
  add_elements(report, core, work);
  add_threads(report);
  add_contact(report, settled != nullptr ? *settled : pile(), settled != nullptr ? "bed" : "pile of boxes");
  return report;
}

std::string table(const Json& report) {
  std::string text;
  for (const auto& [key, value] : report.items()) {
    const std::string shown = value.is_number_float() ? fmt::format("{:.4g}", value.get<double>()) : value.dump();
    text += fmt::format("{:34} {}\n", key, shown);
  }
  return text;
}

}  // namespace qdem::bench
