#include "qdem_solver/participant/rail_foot.hpp"

namespace qdem {

RailFoot::RailFoot(TrackBed& bed, const std::vector<LoadSettings>& loads) : bed_(bed) {
  for (const LoadSettings& settings : loads) {
    if (settings.target != LoadTarget::pads) continue;
    if (settings.load.kind == LoadKind::force) forces_.push_back(settings.load.history);
    if (settings.load.kind == LoadKind::displacement) displacement_ = settings.load.history;
  }
  foot_ = wanted(bed.state().time, 0.0);
}

double RailFoot::force(double time) const {
  double sum = 0.0;
  for (const auto& history : forces_) sum += history(time);
  return sum;
}

std::vector<double> RailFoot::wanted(double time, double ahead) const {
  std::vector<double> u = bed_.pad_displacement(), rate = bed_.pad_velocity();
  double stiffness = 0.0;
  for (const PadCell& cell : bed_.model().pads) stiffness += cell.laws[2].stiffness;
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (displacement_) {
      u[i] = i % 3 == 2 ? -displacement_(time) : 0.0;
    } else {
      u[i] += ahead * rate[i] - (i % 3 == 2 ? force(time) / stiffness : 0.0);
    }
  }
  return u;
}

void RailFoot::advance(double dt, std::int64_t n_steps) {
  if (forces_.empty() && !displacement_) {
    bed_.engine().advance(bed_.state(), dt, n_steps);
    return;
  }
  const double duration = dt * static_cast<double>(n_steps);
  const auto next = wanted(bed_.state().time + duration, duration);
  bed_.engine().advance(bed_.state(), dt, n_steps, {foot_, next});
  foot_ = next;
}

}  // namespace qdem
