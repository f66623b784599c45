#include "qdem_solver/participant/run_alone.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "proto/clock.hpp"
#include "proto/error.hpp"
#include "qdem_solver/participant/bed_record.hpp"
#include "qdem_solver/participant/rail_foot.hpp"

namespace qdem {
namespace {

/// Steps between two looks at load and step; the force on the pads lags by at most as many.
constexpr std::int64_t steps_per_look = 25;

void add_end_state(TrackBed& bed, EnergyWatch& energy, RunFigures& figures) {
  figures.energy = energy.look(bed.engine(), bed.state());
  figures.largest_residual = energy.largest_residual();
  figures.coordination_number = bed.engine().contacts().report(bed.state()).coordination_number;
  const auto displacement = bed.pad_displacement();
  for (std::size_t i = 2; i < displacement.size(); i += 3) {
    figures.sleeper_displacement += 3 * displacement[i] / static_cast<double>(displacement.size());
    figures.pad_force += bed.state().pad_force[i];
  }
}

}  // namespace

RunFigures run_alone(const proto::CaseFile& file, const BedSource& source, const std::string& out,
                     const std::function<void(double)>& report, const std::function<void(const std::string&)>& warn) {
  TrackBed bed(file, source, {}, BedRole::alone);
  const RunAlone& run = bed.settings().run;
  if (run.duration <= 0) file.section("qdem").section("run").fail("duration_s", "there is nothing to run");
  bed.begin_march();
  EnergyWatch energy(warn);
  BedRecord record(bed, energy, {out, run.output_interval, bed.attributes(file)});
  RunFigures figures;
  RailFoot foot(bed, run.loads);
  const auto begin = std::chrono::steady_clock::now();
  figures.smallest_step = run.duration;
  for (std::int64_t look = 1; run.duration - bed.state().time > 1e-9 * bed.largest_step(); ++look) {
    const double left = std::min(run.duration, record.next_time()) - bed.state().time;
    bed.find_step(steps_per_look * bed.largest_step());
    const auto wanted = static_cast<std::int64_t>(std::ceil(left / bed.largest_step()));
    const std::int64_t n = std::min(steps_per_look, wanted);
    const double dt = n == wanted ? left / static_cast<double>(n) : bed.largest_step();
    foot.advance(dt, n);
    figures.steps += n;
    figures.largest_step = std::max(figures.largest_step, dt);
    figures.smallest_step = std::min(figures.smallest_step, dt);
    record.look(bed.state().time);
    if (report && look % 40 == 0) report(bed.state().time);
  }
  figures.wall = proto::seconds_since(begin);
  figures.element_updates_per_s =
      static_cast<double>(figures.steps) * static_cast<double>(bed.model().n_elements()) / figures.wall;
  add_end_state(bed, energy, figures);
  record.close();
  if (run.output_interval > 0) figures.output = out + "/qdem.h5";
  return figures;
}

}  // namespace qdem
