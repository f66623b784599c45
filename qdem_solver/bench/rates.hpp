// How fast the engine and its parts are on a scene.
#pragma once

#include "qdem_solver/bench/scenes.hpp"
#include "qdem_solver/engine/engine.hpp"

namespace qdem::bench {

/// Best of several rounds, by the wall clock and by the CPU time of all threads together: on a busy machine only the
/// second says something about the code.
struct Rate {
  double wall = 0.0, cpu = 0.0;  ///< [1/s]
};

/// Whole steps a second, so small that the scene stays where it is: the cost of a step does not depend on its length.
Rate step_rate(Scene& scene, int threads, int n_steps);
Rate step_rate(Scene& scene, const EngineOptions& options, int n_steps);

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
