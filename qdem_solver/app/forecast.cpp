#include "qdem_solver/app/forecast.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>

#include "proto/case/coupling.hpp"
#include "qdem_solver/bed/forecast.hpp"
#include "qdem_solver/bench/rates.hpp"
#include "qdem_solver/participant/qdem_case.hpp"

namespace qdem {
namespace {

constexpr int small = 20'000, rounds = 50;  // elements of the scene that is stepped, and how often
constexpr double pairs_per_stone = 5;       // that carry a force; measured in settled beds
constexpr double share_of_threads = 0.8;    // of what threads could save in steps of a settled bed, measured
constexpr double bed_steps = 120e3;         // from pouring to rest; measured in the shipped cases' beds

/// One step of a settled bed [s], from the rates of its parts on this machine.
double step_time(const BedForecast& bed, int threads) {
  bench::Scene stones = bench::stones(small);
  const double elements_per_s = static_cast<double>(stones.model.n_elements()) * bench::step_rate(stones, rounds).wall;
  const double pairs_per_s = bench::contact_cost(bench::pile()).pairs_per_s;
  const double one = static_cast<double>(bed.elements) / elements_per_s +
                     pairs_per_stone * static_cast<double>(bed.stones) / pairs_per_s;
  return one / (threads > 1 ? share_of_threads * threads : 1);
}

/// Of the march of a coupled case, or of the run without a coupler [s].
double simulated_time(const proto::CaseFile& file, const QdemCase& settings) {
  if (!file.section("coupling").has("window_s")) return settings.run.duration;
  const proto::Coupling coupling = proto::read_coupling(file);
  return static_cast<double>(coupling.n_windows) * coupling.window_s;
}

std::string minutes(double seconds) {
  return seconds < 60 ? fmt::format("{:.0f} s", seconds) : fmt::format("{:.0f} min", seconds / 60);
}

}  // namespace

void print_forecast(const proto::CaseFile& file) {
  const QdemCase settings = read_qdem_case(file);
  const BedForecast bed = forecast_bed(file, settings.physics);
  double step = settings.step_safety * bed.stone_step_bound;
  if (settings.largest_step > 0) step = std::min(step, settings.largest_step);
  const int threads = settings.threads > 0 ? settings.threads : omp_get_max_threads();
  const double duration = simulated_time(file, settings), steps = duration / step, cost = step_time(bed, threads);
  fmt::print("stones                    {}, with the sleeper {} particles in {} tetrahedra\n", bed.stones,
             bed.particles, bed.elements);
  fmt::print("memory                    about {:.1f} GB\n", 1e-9 * bed.memory_bytes);
  fmt::print("steps                     {:.0f} thousand or more of at most {:.2g} s for {:g} s\n", 1e-3 * steps, step,
             duration);
  fmt::print(
      "wall time                 about {} with {} threads on this machine as busy as it is now; {} more to build "
      "the bed\n",
      minutes(steps * cost), threads, minutes(bed_steps * cost));
}

}  // namespace qdem
