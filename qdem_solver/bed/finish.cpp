// The last part of a Builder: the bed to its place, its figures, its limits.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "proto/error.hpp"
#include "qdem_solver/bed/builder.hpp"
#include "qdem_solver/bed/porosity.hpp"

namespace qdem::bed {
namespace {

using Eigen::Vector3d;

constexpr int sleeper = 0;

/// Mean of the sleeper's top nodes, and its pitch about y from their heights over x.
struct TopFace {
  Vector3d shift = Vector3d::Zero();  ///< mean displacement from the mesh's own place [m]
  double pitch = 0.0;                 ///< [rad]
};

TopFace top_face(const Model& model, const State& state) {
  TopFace top;
  double n = 0, xx = 0, xz = 0;
  const Template& shape = model.shape(sleeper);
  for (int i = 0; i < shape.n_nodes(); ++i) {
    const Vector3d& place = shape.nodes[i];
    if (place[2] < -1e-9) continue;
    const Vector3d moved = state.position(model, sleeper, i) - place;
    top.shift += moved;
    xx += place[0] * place[0], xz += place[0] * moved[2];
    n += 1;
  }
  top.shift /= n;
  top.pitch = xx > 0 ? -xz / xx : 0.0;
  return top;
}

}  // namespace

void Builder::finish() {
  const Settings& s = settings_;
  model_.local_damping = 0, model_.drag_per_s = 0;
  model_.contact = physics_.contact;
  hold_sleeper(0u);  // the rail holds it upright from now on
  const TopFace top = top_face(model_, state_);
  report_.sleeper_shift = top.shift[0];
  report_.sleeper_tilt = top.pitch;
  // Bed and boundaries move as one, so that no contact changes. y stays: the symmetry plane holds it.
  const Vector3d back(-top.shift[0], 0, -top.shift[2]);
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    for (int i = 0; i < model_.shape(b).n_nodes(); ++i) {
      State::scatter(model_, state_.x, b, i, state_.position(model_, b, i) + back);
    }
  }
  for (Plane& plane : model_.planes) plane.point += back;
  for (BoundaryParticle& particle : model_.boundary) particle.rest += back;
  state_.step = 0, state_.time = 0, state_.contact.rebuild_time = 0;
  drop_spare_lanes();

  report_.stones = 0;
  std::int64_t in_stones = 0;
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    if (model_.bodies[b].kind == BodyKind::stone) ++report_.stones, in_stones += model_.shape(b).n_tets();
  }
  report_.elements = in_stones + model_.shape(sleeper).n_tets();
  report_.seed = static_cast<std::int64_t>(s.seed);
  report_.d50 = s.gradation.size_at(0.5);
  report_.elements_per_stone = static_cast<double>(in_stones) / static_cast<double>(report_.stones);
  const double half = s.gradation.size_at(0.5) / 2, r = physics_.contact.rounding, ground = ground_ + back[2];
  const double pitch = std::max(s.gradation.size_at(0.5) / 25, 1e-3);
  const Vector3d low(-s.sleeper.width() / 2, half, ground + half),
      high(s.sleeper.width() / 2, s.half_length() - half, -s.sleeper.height() - half);
  report_.porosity_under_sleeper = porosity(model_, state_, low, high, pitch, r);
  const Vector3d wide(s.spacing / 2 - half, s.half_length(), 0);
  report_.porosity_layer = porosity(model_, state_, Vector3d(-wide[0], half, ground),
                                    Vector3d(wide[0], wide[1], -s.sleeper.height()), pitch, r);
}

void Builder::drop_spare_lanes() {
  for (const Batch& batch : model_.batches) {
    const std::int64_t n = std::int64_t{3} * model_.templates[batch.template_id].n_nodes();
    for (int lane = 0; lane < batch.lanes; ++lane) {
      if (batch.bodies[lane] >= 0) continue;
      for (std::int64_t i = 0; i < n; ++i) {
        state_.x[batch.offset + i * batch.lanes + lane] = state_.x[batch.offset + i * batch.lanes];
        state_.v[batch.offset + i * batch.lanes + lane] = 0;
        state_.a[batch.offset + i * batch.lanes + lane] = 0;
      }
    }
  }
}

void Builder::check_limits() const {
  const Settings& s = settings_;
  const auto refuse = [&](bool bad, const std::string& what, double value, const std::string& key) {
    if (!bad) return;
    std::ostringstream problem;
    problem << "the bed misses a limit: " << what << " is " << value;
    throw proto::Error(proto::ExitCode::bad_data, problem.str(), "[bed] " + key,
                       "change the bed's inputs or the limit; a bed that misses its limits is not stored");
  };
  const double penetration = s.penetration_limit > 0 ? s.penetration_limit : 2 * physics_.contact.rounding;
  const double p = report_.porosity_under_sleeper, q = report_.porosity_layer;
  refuse(!(p >= s.porosity_lowest && p <= s.porosity_highest), "porosity under the sleeper", p, "porosity_limits");
  refuse(!(q >= s.porosity_lowest && q <= s.porosity_highest), "porosity of the layer", q, "porosity_limits");
  refuse(!(report_.unbalanced_force_ratio <= s.unbalanced_limit), "the unbalanced force ratio",
         report_.unbalanced_force_ratio, "unbalanced_limit");
  refuse(!(report_.kinetic_energy <= s.kinetic_limit), "the kinetic energy [J]", report_.kinetic_energy,
         "kinetic_energy_limit_j");
  refuse(!(report_.largest_penetration <= penetration), "the largest penetration [m]", report_.largest_penetration,
         "penetration_limit_m");
  refuse(!(std::abs(report_.sleeper_tilt) <= s.tilt_limit), "the sleeper's tilt [rad]", report_.sleeper_tilt,
         "sleeper_tilt_limit_rad");
}

}  // namespace qdem::bed
