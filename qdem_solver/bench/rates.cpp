#include "qdem_solver/bench/rates.hpp"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>

#include "proto/clock.hpp"
#include "qdem_solver/bench/machine_rates.hpp"
#include "qdem_solver/engine/stability.hpp"

namespace qdem::bench {
namespace {

constexpr int rounds = 200, searches = 5;
constexpr int steps_a_call = 10;    // about a window's: threads are woken once for all of them
constexpr double tiny_step = 1e-8;  // [s]

class Clock {
 public:
  double wall() const { return proto::seconds_since(wall_); }
  double cpu() const { return static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC; }

 private:
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  std::clock_t cpu_ = std::clock();
};

}  // namespace

Rate step_rate(Scene& scene, int n_rounds) {
  Engine engine(scene.model, {1});
  engine.prepare(scene.state);
  Rate best;
  for (int round = 0; round < n_rounds; ++round) {
    const double flops = core_flop_rate();
    const Clock clock;
    engine.advance(scene.state, tiny_step, 1);
    best = {std::max(best.wall, 1 / clock.wall()), std::max(best.cpu, 1 / clock.cpu()), std::max(best.flops, flops)};
  }
  return best;
}

double call_rate(Scene& scene, const EngineOptions& options, int n_rounds, int n_steps) {
  Engine engine(scene.model, options);
  engine.prepare(scene.state);
  double best = 0.0;
  for (int round = 0; round < n_rounds; ++round) {
    const Clock clock;
    engine.advance(scene.state, tiny_step, n_steps);
    best = std::max(best, n_steps / clock.wall());
  }
  return best;
}

double two_thread_speedup(Scene& scene) {
  double time[2] = {1e9, 1e9};
  Engine engines[2] = {Engine(scene.model, {1}), Engine(scene.model, {2})};
  engines[0].prepare(scene.state);
  for (int round = 0; round < rounds / 2; ++round) {
    for (int i = 0; i < 2; ++i) {
      const Clock clock;
      engines[i].advance(scene.state, tiny_step, steps_a_call);
      time[i] = std::min(time[i], clock.wall());
    }
  }
  return time[0] / time[1];
}

ContactCost contact_cost(const Scene& scene) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  ContactCost cost;
  cost.candidates_time_s = 1e9;
  State state = scene.state;
  ContactStage stage(scene.model);
  for (int round = 0; round < searches; ++round) {
    state.contact.list_id = 0;
    const Clock clock;
    stage.update_candidates(state);
    cost.candidates_time_s = std::min(cost.candidates_time_s, clock.wall());
  }
  std::vector<double> force(state.x.size(), 0.0);
  stage.compute(state, 0.0);
  cost.live = stage.report(state).live;
  for (int round = 0; round < rounds; ++round) {
    const Clock clock;
    stage.compute(state, 0.0);
    for (int body = 0; body < static_cast<int>(scene.model.bodies.size()); ++body) stage.gather(body, force);
    cost.pairs_per_s = std::max(cost.pairs_per_s, static_cast<double>(cost.live) / clock.cpu());
  }
  omp_set_num_threads(threads);
  return cost;
}

double stable_step(const Scene& scene) {
  State state = scene.state;
  Engine engine(scene.model);
  engine.prepare(state);
  return StepBound(scene.model).at(state, engine.contacts(), near_gap(scene.model.contact));
}

bool same_bits(const Scene& scene, int threads, int n_steps) {
  State one = scene.state, several = scene.state;
  for (auto [state, n] : {std::pair{&one, 1}, std::pair{&several, threads}}) {
    Engine engine(scene.model, {n});
    engine.prepare(*state);
    engine.advance(*state, tiny_step, n_steps);
  }
  return std::memcmp(one.x.data(), several.x.data(), sizeof(double) * one.x.size()) == 0 &&
         std::memcmp(one.v.data(), several.v.data(), sizeof(double) * one.v.size()) == 0;
}

}  // namespace qdem::bench
