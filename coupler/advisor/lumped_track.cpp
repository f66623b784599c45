#include "coupler/advisor/lumped_track.hpp"

namespace coupler {
namespace {

namespace field = proto::field;

double value(const proto::Advance& request, const char* name) {
  return request.data.get(name).at(0);
}

/// Path of the rail over a window, s from 0 to 1; coupler/README.md "Prolongation".
struct RailPath {
  double begin, end, slope_begin, slope_end, window_s;
  bool cubic;

  explicit RailPath(const proto::Advance& request)
      : begin(value(request, field::rail_displacement_begin)),
        end(value(request, field::rail_displacement)),
        slope_begin(0.0),
        slope_end(0.0),
        window_s(request.window_s),
        cubic(request.data.has(field::path_velocity)) {
    if (!cubic) return;
    slope_begin = value(request, field::path_velocity_begin) * window_s;
    slope_end = value(request, field::path_velocity) * window_s;
  }
  double displacement(double s) const {
    if (!cubic) return begin + (end - begin) * s;
    const double r = 1 - s;
    return r * r * ((1 + 2 * s) * begin + s * slope_begin) + s * s * ((3 - 2 * s) * end - r * slope_end);
  }
  double velocity(double s) const {
    if (!cubic) return (end - begin) / window_s;
    return (6 * s * (1 - s) * (end - begin) + (1 - s) * (1 - 3 * s) * slope_begin + s * (3 * s - 2) * slope_end) /
           window_s;
  }
};

}  // namespace

proto::Result LumpedRail::advance(const proto::Advance& request) {
  u_before_ = u_, v_before_ = v_;
  proto::Result result{request.phase, request.window, request.iteration, 0.0, {}};
  double used = 0.0;
  if (request.data.has(field::force_carry)) {
    const double robin = solve_robin(request), carry = value(request, field::force_carry);
    result.data.set(field::force_robin, {robin});
    used = robin - carry;
  } else {
    used = request.data.has(field::joint_force)
               ? (value(request, field::joint_force_begin) + value(request, field::joint_force)) / 2
               : value(request, field::force_mean);
    step(request.window_s, 0.0, 0.0, mean_load(request) - used);
  }
  result.data.set(field::rail_displacement, {u_});
  result.data.set(field::rail_velocity, {v_});
  result.data.set(field::force_used, {used});
  return result;
}

double LumpedRail::solve_robin(const proto::Advance& request) {
  const double h = request.window_s, x = value(request, field::sleeper_mean_displacement),
               y = value(request, field::sleeper_mean_velocity);
  const double load = mean_load(request) + value(request, field::force_carry);
  const proto::PadLaw& pad = track_.pad;
  step(h, pad.stiffness, pad.damping, load + pad.stiffness * x + pad.damping * y);
  const double gap = (u_before_ + u_) / 2 - x, rate = (u_ - u_before_) / h - y;
  if (!pad.engaged(gap, rate)) {
    u_ = u_before_, v_ = v_before_;
    step(h, 0.0, 0.0, load - pad.preload);
  }
  return pad.force(gap, rate);
}

void LumpedRail::step(double h, double k, double c, double load) {
  // M (v1 - v0)/H + (K + k)(u0 + u1)/2 + c (u1 - u0)/H = load with u1 = u0 + H (v0 + v1)/2, solved for v1.
  const double stiffness = track_.rail_stiffness + k, mass = track_.rail_mass;
  const double v1 =
      (load + mass / h * v_ - stiffness * (u_ + h * v_ / 4) - c * v_ / 2) / (mass / h + stiffness * h / 4 + c / 2);
  u_ += h * (v_ + v1) / 2;
  v_ = v1;
}

proto::Result LumpedSleeper::advance(const proto::Advance& request) {
  x_before_ = x_, y_before_ = y_;
  const Sums sums = request.data.has(field::joint_force) ? under_joint_force(request) : along_path(request);
  proto::Result result{request.phase, request.window, request.iteration, 0.0, {}};
  result.data.set(field::impulse, {sums.impulse});
  result.data.set(field::pad_work, {sums.work});
  result.data.set(field::sleeper_displacement, {x_});
  result.data.set(field::sleeper_velocity, {y_});
  return result;
}

LumpedSleeper::Sums LumpedSleeper::along_path(const proto::Advance& request) {
  const RailPath path(request);
  const double h = request.window_s / request.sub_cycles, m = track_.sleeper_mass;
  const double k = track_.pad.stiffness, c = track_.pad.damping, cb = track_.sleeper_damping;
  double u = path.begin, f = track_.pad.force(u - x_, path.velocity(0.0) - y_);
  Sums sums;
  for (std::uint32_t j = 1; j <= request.sub_cycles; ++j) {
    const double s = static_cast<double>(j) / request.sub_cycles;
    const double half = y_ + h / 2 * (f - track_.sleeper_stiffness * x_ - cb * y_) / m;
    x_ += h * half;
    const double u_next = path.displacement(s), rate = path.velocity(s);
    // Off the rail only the clip pulls: then the pad's dashpot does not act either.
    const bool engaged = track_.pad.engaged(u_next - x_, rate - half);
    const double pad = engaged ? k * (u_next - x_) + c * rate : track_.pad.preload;
    y_ = (half + h / 2 / m * (pad - track_.sleeper_stiffness * x_)) / (1 + h * ((engaged ? c : 0.0) + cb) / (2 * m));
    const double f_next = engaged ? pad - c * y_ : pad;
    sums.impulse += h * (f + f_next) / 2;
    sums.work += (f + f_next) / 2 * (u_next - u);
    u = u_next, f = f_next;
  }
  return sums;
}

LumpedSleeper::Sums LumpedSleeper::under_joint_force(const proto::Advance& request) {
  const double begin = value(request, field::joint_force_begin), end = value(request, field::joint_force);
  const double h = request.window_s / request.sub_cycles, m = track_.sleeper_mass, cb = track_.sleeper_damping;
  double f = begin;
  Sums sums;
  for (std::uint32_t j = 1; j <= request.sub_cycles; ++j) {
    const double f_next = begin + (end - begin) * j / request.sub_cycles, x_old = x_;
    const double half = y_ + h / 2 * (f - track_.sleeper_stiffness * x_ - cb * y_) / m;
    x_ += h * half;
    y_ = (half + h / 2 / m * (f_next - track_.sleeper_stiffness * x_)) / (1 + h * cb / (2 * m));
    sums.impulse += h * (f + f_next) / 2;
    sums.work += (f + f_next) / 2 * (x_ - x_old);
    f = f_next;
  }
  return sums;
}

}  // namespace coupler
