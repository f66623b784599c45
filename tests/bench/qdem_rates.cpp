// Element updates a second of a whole step (forces, gather, kick, drift), without contact: stones in lanes, and one
// large body. Prints; asserts only that the machine did something.
#include <gtest/gtest.h>
#include <chrono>
#include <ctime>

#include "qdem_solver/engine/cpu/kernels.hpp"
#include "qdem_solver/engine/engine.hpp"
#include "tests/support/box_mesh.hpp"

namespace {

/// Best of five rounds by the wall clock, and by the CPU time of all threads together: on a busy machine only the
/// second says something about the code.
struct Rate {
  double wall = 0, cpu = 0;
};

Rate rate(const qdem::Model& model, qdem::State& state, int threads, int n_steps) {
  qdem::Engine engine(model, {threads});
  engine.prepare(state);
  double elements = 0;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) elements += model.shape(body).n_tets();
  Rate best;
  for (int round = 0; round < 5; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    const std::clock_t cpu_begin = std::clock();
    engine.advance(state, 1e-8, n_steps);
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const double cpu = static_cast<double>(std::clock() - cpu_begin) / CLOCKS_PER_SEC;
    best = {std::max(best.wall, elements * n_steps / wall), std::max(best.cpu, elements * n_steps / cpu)};
  }
  return best;
}

void print(const char* what, const qdem::Model& model, qdem::State state, int n_steps) {
  for (const int threads : {1, 2}) {
    const Rate found = rate(model, state, threads, n_steps);
    std::cout << what << ", " << threads << " threads: " << 1e-6 * found.wall << " M element updates/s, "
              << 1e-6 * found.cpu << " a CPU second (" << qdem::cpu::kernels().instruction_set << ")\n";
  }
}

qdem::Material stone() {
  return tests::with_retardation(tests::rock(), 1e-7);
}

}  // namespace

TEST(Rates, StonesInLanes) {
  for (const int n : {160, 1600, 8000}) {
    const auto model = tests::free_bodies(tests::box_template({3, 3, 2}, {0.06, 0.05, 0.04}), stone(), n);
    const std::string name = std::to_string(n) + " stones of 108 tetrahedra";
    print(name.c_str(), model, qdem::make_state(model, tests::apart(n, 0.3)), 100000 / n);
  }
}

TEST(Rates, OneLargeBody) {
  const auto model = tests::free_bodies(tests::box_template({40, 9, 6}, {1.3, 0.3, 0.2}), stone());
  print("one body of 12960 tetrahedra", model, qdem::make_state(model, {{}}), 100);
}
