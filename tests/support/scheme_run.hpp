// Runs a coupling scheme on the split oscillator in one process.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "coupler/scheme/audit.hpp"
#include "coupler/scheme/coupling_scheme.hpp"
#include "coupler/scheme/observation.hpp"
#include "tests/support/oscillator_sides.hpp"
#include "tests/support/tolerance.hpp"

namespace tests {

/// A scheme of proto with its settings, on `track`.
struct SchemeCase {
  proto::Coupling coupling;
  coupler::LumpedTrack track = Oscillator();
  double end_time = 4.0;

  explicit SchemeCase(proto::Scheme scheme) { coupling.scheme = scheme; }
  /// Iterations to round-off.
  SchemeCase& converged() {
    coupling.iteration.force_tolerance = coupling.iteration.displacement_tolerance = 1e-14;
    coupling.iteration.accept_at_limit = true;
    coupling.iteration.max_iterations = 12;
    return *this;
  }
};

struct SchemeRun {
  Eigen::Vector4d end;                                ///< (u, u', x, x') at the end
  double energy_defect = 0.0, momentum_defect = 0.0;  ///< relative
  double raw_defect = 0.0, momentum_sum = 0.0;        ///< R_n and sum of P at the last window
  double mean_solves = 0.0;
  std::vector<double> pad_force;  ///< window means
};

inline std::unique_ptr<coupler::CouplingScheme> scheme_of(const SchemeCase& c, double window_s,
                                                          std::uint32_t sub_cycles) {
  auto scheme = coupler::make_scheme(c.coupling.scheme, c.coupling, {window_s, sub_cycles, {c.track.pad}});
  scheme->start({{c.track.u}, {c.track.v}, {c.track.x}, {c.track.y}});
  return scheme;
}

/// The audit and the wire see three axes; the models move along the first.
inline coupler::WindowRecord three_axes(coupler::WindowRecord record) {
  for (auto* values : {&record.rail_displacement_begin, &record.rail_displacement, &record.force_used, &record.impulse,
                       &record.pad_work, &record.force_law, &record.force_robin})
    values->resize(3, 0.0);
  return record;
}

template <class Rail = RailModel, class Sleeper = SleeperModel>
SchemeRun run_scheme(const SchemeCase& c, int n_windows, std::uint32_t sub_cycles) {
  const double h = c.end_time / n_windows;
  Rail rail(c.track);
  Sleeper sleeper(c.track);
  auto scheme = scheme_of(c, h, sub_cycles);
  coupler::Audit audit({{{{0.0, 0.0, 0.0}}, 1.0}}, h);
  coupler::Observation seen(n_windows, h);
  SchemeRun result;
  coupler::WindowRecord record;
  for (int n = 0; n < n_windows; ++n) {
    record = scheme->advance(proto::Phase::march, n, {rail, sleeper});
    scheme->commit(n, {rail, sleeper});
    result.momentum_sum += h * record.force_used[0] - record.impulse[0];
    result.raw_defect = h * record.force_robin[0] - record.impulse[0];
    result.pad_force.push_back(record.impulse[0] / h);
    audit.add(three_axes(record));
    seen.add(record);
  }
  result.end << record.rail_displacement[0], record.rail_velocity[0], record.sleeper_displacement[0],
      record.sleeper_velocity[0];
  result.energy_defect = audit.energy_defect_relative();
  result.momentum_defect = audit.momentum_defect_relative();
  result.mean_solves = seen.mean_solves();
  return result;
}

/// Order of the error of the end state against `exact` over the last two halvings of three.
template <class Rail = RailModel, class Sleeper = SleeperModel>
double observed_order(const SchemeCase& c, const Eigen::Vector4d& exact, std::uint32_t sub_cycles,
                      const std::vector<int>& windows = {160, 320, 640}) {
  std::vector<double> steps, errors;
  for (const int n : windows) {
    steps.push_back(c.end_time / n);
    errors.push_back((run_scheme<Rail, Sleeper>(c, n, sub_cycles).end - exact).norm());
  }
  return fitted_order(steps, errors);
}

}  // namespace tests
