// How fast the engine and its parts are on a scene.
#pragma once

#include "qdem_solver/bench/scenes.hpp"
#include "qdem_solver/engine/engine.hpp"

namespace qdem::bench {

/// Best of many rounds. The wall clock cannot flatter, and where rounds are shorter than a time slice some of them are
/// left alone even on a busy machine; the CPU time is for rounds that are longer.
struct Rate {
  double wall = 0.0, cpu = 0.0;  ///< [1/s]
  double flops = 0.0;            ///< core_flop_rate() between the rounds, the best too [1/s]
};

/// Whole steps a second of one thread, so small that the scene stays where it is: the cost of a step does not depend on
/// its length. A round is one step.
Rate step_rate(Scene& scene, int n_rounds);

/// Steps a second of any engine by the wall clock [1/s]; a round is one call of `n_steps`.
double call_rate(Scene& scene, const EngineOptions& options, int n_rounds, int n_steps);

/// Rate of two threads over that of one by the wall clock, their steps in turn.
double two_thread_speedup(Scene& scene);

struct ContactCost {
  std::int64_t live = 0;           ///< contacts that carry a force
  double pairs_per_s = 0.0;        ///< of them computed and gathered, on one core
  double candidates_time_s = 0.0;  ///< of one candidate list, on one core
};
ContactCost contact_cost(const Scene& scene);

/// Largest stable step of the scene as it is [s].
double stable_step(const Scene& scene);

/// Whether `n_steps` steps give the same bytes with one thread and with `threads`.
bool same_bits(const Scene& scene, int threads, int n_steps);

}  // namespace qdem::bench
