#include "qdem_solver/participant/run_alone.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "proto/error.hpp"
#include "qdem_solver/output/contacts_file.hpp"
#include "qdem_solver/output/fields_file.hpp"
#include "qdem_solver/sensors/sensor_file.hpp"

namespace qdem {
namespace {

/// Steps between two looks at load and step; the force lags by at most as many.
constexpr std::int64_t steps_per_look = 25;

/// Rail foot that presses every cell with a given force: it follows the sleeper, deeper by the spring's compression.
class PressingFoot {
 public:
  PressingFoot(TrackBed& bed, double force) : bed_(bed), foot_(wanted(force, 0.0)) {}

  void advance(double dt, std::int64_t n_steps, double end_force) {
    const auto next = wanted(end_force, dt * static_cast<double>(n_steps));
    bed_.engine().advance(bed_.state(), dt, n_steps, {foot_, next});
    foot_ = next;
  }

 private:
  std::vector<double> wanted(double force, double ahead) const {
    std::vector<double> u = bed_.pad_displacement(), rate = bed_.pad_velocity();
    double stiffness = 0.0;
    for (const PadCell& cell : bed_.model().pads) stiffness += cell.laws[2].stiffness;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += ahead * rate[i] - (i % 3 == 2 ? force / stiffness : 0.0);
    return u;
  }

  TrackBed& bed_;
  std::vector<double> foot_;
};

/// qdem.h5 and sensors.h5, written when they are due.
class OutputClock {
 public:
  OutputClock(TrackBed& bed, const proto::CaseFile& file, const std::string& out)
      : bed_(bed), interval_(bed.settings().run.output_interval) {
    const auto attributes = bed.attributes(file);
    if (interval_ > 0) {
      path_ = out + "/qdem.h5";
      fields_.emplace(path_, bed.model(), bed.state(), attributes);
      if (bed.settings().contact_output) contacts_.emplace(out + "/contacts.h5", attributes);
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
    if (!fields_ || time < static_cast<double>(n_written_) * interval_ * (1 - 1e-9)) return;
    fields_->write(time, bed_.state(), bed_.engine());
    if (contacts_) contacts_->write(time, bed_.state(), bed_.engine().contacts());
    ++n_written_;
  }
  std::string close() {
    if (fields_) fields_->close();
    if (sensors_) sensors_->close();
    if (contacts_) contacts_->close();
    return path_;
  }

 private:
  TrackBed& bed_;
  double interval_;
  std::int64_t n_written_ = 0;
  std::string path_;
  std::optional<FieldsFile> fields_;
  std::optional<SensorFile> sensors_;
  std::optional<ContactsFile> contacts_;
};

void add_end_state(TrackBed& bed, RunFigures& figures) {
  figures.kinetic_energy = bed.engine().energies(bed.state()).kinetic;
  figures.coordination_number = bed.engine().contacts().report(bed.state()).coordination_number;
  const auto displacement = bed.pad_displacement();
  for (std::size_t i = 2; i < displacement.size(); i += 3) {
    figures.sleeper_displacement += 3 * displacement[i] / static_cast<double>(displacement.size());
    figures.pad_force += bed.state().pad_force[i];
  }
}

}  // namespace

RunFigures run_alone(const proto::CaseFile& file, const BedSource& source, const std::string& out,
                     const std::function<void(double)>& report) {
  TrackBed bed(file, source, {});
  const RunAlone& run = bed.settings().run;
  if (run.duration <= 0) file.section("qdem").section("run").fail("duration_s", "there is nothing to run");
  bed.reset_clock();
  OutputClock output(bed, file, out);
  RunFigures figures;
  std::optional<PressingFoot> foot;
  if (run.load) foot.emplace(bed, run.load(0.0));
  const auto begin = std::chrono::steady_clock::now();
  figures.smallest_step = run.duration;
  for (std::int64_t look = 1; run.duration - bed.state().time > 1e-9 * bed.largest_step(); ++look) {
    const double left = std::min(run.duration, output.next_time()) - bed.state().time;
    bed.find_step(steps_per_look * bed.largest_step());
    const auto wanted = static_cast<std::int64_t>(std::ceil(left / bed.largest_step()));
    const std::int64_t n = std::min(steps_per_look, wanted);
    const double dt = n == wanted ? left / static_cast<double>(n) : bed.largest_step();
    const double end = bed.state().time + dt * static_cast<double>(n);
    if (foot) {
      foot->advance(dt, n, run.load(end));
    } else {
      bed.engine().advance(bed.state(), dt, n);
    }
    figures.steps += n;
    figures.largest_step = std::max(figures.largest_step, dt);
    figures.smallest_step = std::min(figures.smallest_step, dt);
    output.look();
    if (report && look % 40 == 0) report(end);
  }
  figures.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  figures.element_updates_per_s =
      static_cast<double>(figures.steps) * static_cast<double>(bed.model().n_elements()) / figures.wall;
  add_end_state(bed, figures);
  figures.output = output.close();
  return figures;
}

}  // namespace qdem
