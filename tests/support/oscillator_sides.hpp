// The split oscillator in one process: two model participants for the coupling schemes, and its closed form.
//
// Rail mass on a spring, pad, sleeper mass on a spring (coupling test problem T2): mA = 1 kg, kA = 1 N/m, mB = 0.5 kg,
// kB = 4 N/m, pad 10 N/m and 0.2 N s/m; start u = 1 m, x = -0.5 m, x' = 0.3 m/s.
#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/MatrixFunctions>

#include "coupler/scheme/side.hpp"
#include "proto/pad/pad_law.hpp"

namespace tests {

struct Oscillator {
  double rail_mass = 1.0, rail_stiffness = 1.0, sleeper_mass = 0.5, sleeper_stiffness = 4.0;
  proto::PadLaw pad{10.0, 0.2, 0.0, false};
  double u = 1.0, v = 0.0, x = -0.5, y = 0.3;
  double rail_load = 0.0;  ///< constant [N]; not part of the closed form
};

/// (u, u', x, x') at `time` by the matrix exponential.
inline Eigen::Vector4d exact_state(const Oscillator& o, double time) {
  const double k = o.pad.stiffness, c = o.pad.damping;
  Eigen::Matrix4d a;
  a << 0, 1, 0, 0,                                                                                //
      -(o.rail_stiffness + k) / o.rail_mass, -c / o.rail_mass, k / o.rail_mass, c / o.rail_mass,  //
      0, 0, 0, 1,                                                                                 //
      k / o.sleeper_mass, c / o.sleeper_mass, -(o.sleeper_stiffness + k) / o.sleeper_mass, -c / o.sleeper_mass;
  return (a * time).exp() * Eigen::Vector4d(o.u, o.v, o.x, o.y);
}

/// Rail mass, average-acceleration Newmark in momentum form, with the pad in the matrix when it is asked for Robin.
class RailModel : public coupler::Side {
 public:
  explicit RailModel(const Oscillator& o) : o_(o), u_(o.u), v_(o.v) {}
  proto::Result advance(const proto::Advance& request) override;
  void rollback(const proto::Rollback&) override { u_ = u_before_, v_ = v_before_; }
  void commit(const proto::Commit&) override {}
  void damp(double factor) { v_ *= factor; }
  double displacement() const { return u_; }
  double velocity() const { return v_; }

 private:
  Oscillator o_;
  double u_, v_, u_before_ = 0.0, v_before_ = 0.0;
};

/// Sleeper mass, kick-drift-kick with the dashpot at the end velocity of each sub-step.
class SleeperModel : public coupler::Side {
 public:
  explicit SleeperModel(const Oscillator& o) : o_(o), x_(o.x), y_(o.y) {}
  proto::Result advance(const proto::Advance& request) override;
  void rollback(const proto::Rollback&) override { x_ = x_before_, y_ = y_before_; }
  void commit(const proto::Commit&) override {}
  void damp(double factor) { y_ *= factor; }
  double displacement() const { return x_; }
  double velocity() const { return y_; }

 private:
  Oscillator o_;
  double x_, y_, x_before_ = 0.0, y_before_ = 0.0;
};

inline proto::Result RailModel::advance(const proto::Advance& request) {
  u_before_ = u_, v_before_ = v_;
  const double h = request.window_s, k = o_.pad.stiffness, c = o_.pad.damping;
  const bool robin = request.data.has(proto::field::force_carry);
  const double carry = robin ? request.data.get(proto::field::force_carry).at(0) : 0.0;
  // M (v1 - v0)/H + K (u0 + u1)/2 = F - f_used with u1 = u0 + H (v0 + v1)/2, solved for v1.
  double left = o_.rail_mass / h + o_.rail_stiffness * h / 4;
  double right = o_.rail_load + o_.rail_mass / h * v_ - o_.rail_stiffness * (u_ + h * v_ / 4);
  double x = 0, y = 0;
  if (robin) {
    x = request.data.get(proto::field::sleeper_mean_displacement).at(0);
    y = request.data.get(proto::field::sleeper_mean_velocity).at(0);
    left += k * h / 4 + c / 2;
    right += -k * (u_ + h * v_ / 4 - x) - c * (v_ / 2 - y) + carry;
  } else {
    right -= request.data.get(proto::field::force_mean).at(0);
  }
  const double v1 = right / left, u1 = u_ + h * (v_ + v1) / 2;
  const double force_robin = k * ((u_ + u1) / 2 - x) + c * ((u1 - u_) / h - y);
  const double force_used = robin ? force_robin - carry : request.data.get(proto::field::force_mean).at(0);
  u_ = u1, v_ = v1;
  proto::Result result{request.phase, request.window, request.iteration, 0.0, {}};
  result.data.set(proto::field::rail_displacement, {u1});
  result.data.set(proto::field::rail_velocity, {v1});
  if (robin) result.data.set(proto::field::force_robin, {force_robin});
  result.data.set(proto::field::force_used, {force_used});
  return result;
}

inline proto::Result SleeperModel::advance(const proto::Advance& request) {
  x_before_ = x_, y_before_ = y_;
  const double u0 = request.data.get(proto::field::rail_displacement_begin).at(0);
  const double u1 = request.data.get(proto::field::rail_displacement).at(0);
  const double h = request.window_s / request.sub_cycles, rate = (u1 - u0) / request.window_s;
  const double k = o_.pad.stiffness, c = o_.pad.damping, m = o_.sleeper_mass;
  double u = u0, f = o_.pad.force(u - x_, rate - y_), impulse = 0, work = 0;
  for (std::uint32_t j = 0; j < request.sub_cycles; ++j) {
    const double half = y_ + h / 2 * (f - o_.sleeper_stiffness * x_) / m;
    x_ += h * half;
    const double u_next = u0 + (u1 - u0) * (j + 1) / request.sub_cycles;
    y_ = (half + h / 2 / m * (k * (u_next - x_) + c * rate - o_.sleeper_stiffness * x_)) / (1 + h * c / (2 * m));
    const double f_next = o_.pad.force(u_next - x_, rate - y_);
    impulse += h * (f + f_next) / 2;
    work += (f + f_next) / 2 * (u_next - u);
    u = u_next, f = f_next;
  }
  proto::Result result{request.phase, request.window, request.iteration, 0.0, {}};
  result.data.set(proto::field::impulse, {impulse});
  result.data.set(proto::field::pad_work, {work});
  result.data.set(proto::field::sleeper_displacement, {x_});
  result.data.set(proto::field::sleeper_velocity, {y_});
  return result;
}

}  // namespace tests
