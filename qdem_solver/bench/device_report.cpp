#include "qdem_solver/bench/device_report.hpp"

#include <fmt/format.h>

#include "qdem_solver/bench/rates.hpp"
#include "qdem_solver/engine/stepper.hpp"

namespace qdem::bench {
namespace {

constexpr int rounds = 5;

std::string row(const char* name, Scene scene, int n_steps, double memory_rate) {
  const auto n = static_cast<double>(scene.model.n_elements());
  const double bytes = device_bytes_per_element(scene);
  EngineOptions options;
  options.kind = EngineKind::cuda;
  const double steps = call_rate(scene, options, rounds, n_steps);
  return fmt::format("{:24} {:10.0f} {:10.1f} {:14.1f} {:10.0f} {:10.2f}\n", name, n, 1e6 / steps, 1e-6 * steps * n,
                     bytes, steps * n * bytes / memory_rate);
}

}  // namespace

double device_bytes_per_element(const Scene& scene) {
  constexpr double value = sizeof(double);
  // Drift: x, v in and out, a in; elements: x, v in; sums and kick: v, a in and out, 1/m in, where its contacts begin.
  constexpr double particle = 3 * (5 + 2 + 5) * value + sizeof(int);
  constexpr double slots = 2 * 12 * value;                           // out and in
  constexpr double shape = (9 + 1) * value + (4 + 4) * sizeof(int);  // where no other body shares it
  const auto n = static_cast<double>(scene.model.n_elements());
  const bool shared = scene.model.bodies.size() > scene.model.templates.size();
  return particle * static_cast<double>(scene.model.n_values) / 3 / n + slots + (shared ? 0.0 : shape);
}

std::string device_table() {
  const DeviceRates device = measure_cuda_device();
  std::string text = fmt::format("{}: {:.0f} GB/s by a plain copy\n", device.name, 1e-9 * device.copy_rate);
  text += fmt::format("{:24} {:>10} {:>10} {:>14} {:>10} {:>10}\n", "scene", "elements", "us a step", "M elements/s",
                      "bytes/el", "of memory");
  text += row("stones of one template", stones(20'000), 5000, device.copy_rate);
  text += row("stones of one template", stones(200'000), 2000, device.copy_rate);
  text += row("stones of one template", stones(2'000'000), 500, device.copy_rate);
  text += row("one mesh", single_mesh(200'000), 2000, device.copy_rate);
  text += row("one mesh", single_mesh(2'000'000), 500, device.copy_rate);
  text += row("pile in contact", pile(), 2000, device.copy_rate);
  return text;
}

}  // namespace qdem::bench
