#include "qdem_solver/participant/run_alone.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "proto/error.hpp"
#include "qdem_solver/output/fields_file.hpp"
#include "qdem_solver/participant/energy_watch.hpp"
#include "qdem_solver/participant/rail_foot.hpp"
#include "qdem_solver/sensors/sensor_file.hpp"

namespace qdem {
namespace {

/// Steps between two looks at load and step; the force on the pads lags by at most as many.
constexpr std::int64_t steps_per_look = 25;

/// qdem.h5 and sensors.h5, written when they are due.
class OutputClock {
 public:
  OutputClock(TrackBed& bed, const proto::CaseFile& file, const std::string& out, EnergyWatch& energy)
      : bed_(bed), energy_(energy), interval_(bed.settings().run.output_interval) {
    const auto attributes = bed.attributes(file);
    if (interval_ > 0) {
      path_ = out + "/qdem.h5";
      fields_.emplace(path_, bed.model(), bed.state(), attributes);
    }
    const SensorsSettings& sensors = bed.settings().sensors;
    if (!sensors.list.empty()) sensors_.emplace(out + "/sensors.h5", sensors, bed.model(), bed.state(), attributes);
    look();
  }
  /// When something is due next [s].
  double next_time() const {
    double next = std::numeric_limits<double>::infinity();
    if (fields_) next = static_cast<double>(n_written_) * interval_;
    if (sensors_) next = std::min(next, sensors_->next_time());
    return next;
  }
  void look() {
    const double time = bed_.state().time;
    if (sensors_) sensors_->look(time, bed_.state(), bed_.engine().contacts());
    const bool due = fields_ && time >= static_cast<double>(n_written_) * interval_ * (1 - 1e-9);
    if (!due && bed_.state().step - last_energy_look_ < steps_per_energy_look) return;
    last_energy_look_ = bed_.state().step;
    const EnergyBalance& balance = energy_.look(bed_.engine(), bed_.state());
    if (!due) return;
    fields_->write(time, bed_.state(), bed_.engine(), balance);
    ++n_written_;
  }
  std::string close() {
    if (fields_) fields_->close();
    if (sensors_) sensors_->close();
    return path_;
  }

 private:
  TrackBed& bed_;
  EnergyWatch& energy_;
  double interval_;
  std::int64_t last_energy_look_ = 0;
  std::int64_t n_written_ = 0;
  std::string path_;
  std::optional<FieldsFile> fields_;
  std::optional<SensorFile> sensors_;
};

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
  OutputClock output(bed, file, out, energy);
  RunFigures figures;
  RailFoot foot(bed, run.loads);
  const auto begin = std::chrono::steady_clock::now();
  figures.smallest_step = run.duration;
  for (std::int64_t look = 1; run.duration - bed.state().time > 1e-9 * bed.largest_step(); ++look) {
    const double left = std::min(run.duration, output.next_time()) - bed.state().time;
    bed.find_step(steps_per_look * bed.largest_step());
    const auto wanted = static_cast<std::int64_t>(std::ceil(left / bed.largest_step()));
    const std::int64_t n = std::min(steps_per_look, wanted);
    const double dt = n == wanted ? left / static_cast<double>(n) : bed.largest_step();
    foot.advance(dt, n);
    figures.steps += n;
    figures.largest_step = std::max(figures.largest_step, dt);
    figures.smallest_step = std::min(figures.smallest_step, dt);
    output.look();
    if (report && look % 40 == 0) report(bed.state().time);
  }
  figures.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  figures.element_updates_per_s =
      static_cast<double>(figures.steps) * static_cast<double>(bed.model().n_elements()) / figures.wall;
  add_end_state(bed, energy, figures);
  figures.output = output.close();
  return figures;
}

}  // namespace qdem
