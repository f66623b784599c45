// One seat of track as two masses: the sides that schemes are judged with before a run.
#pragma once

#include "coupler/scheme/side.hpp"
#include "proto/pad/pad_law.hpp"

namespace coupler {

/// Rail mass on a ground spring, pad, sleeper mass on a ground spring and dashpot; motion along one axis. SI units.
struct LumpedTrack {
  double rail_mass = 1.0, rail_stiffness = 0.0;
  double sleeper_mass = 1.0, sleeper_stiffness = 0.0, sleeper_damping = 0.0;
  proto::PadLaw pad;
  double u = 0.0, v = 0.0, x = 0.0, y = 0.0;  ///< rail, sleeper at time 0 [m], [m/s]
  double rail_load = 0.0;                     ///< constant [N]
};

/// Rail mass: average-acceleration Newmark in momentum form, with the pad in the matrix, cut-off included, when it is
/// asked for Robin; else under a mean force or a joint force.
class LumpedRail : public Side {
 public:
  explicit LumpedRail(const LumpedTrack& track) : track_(track), u_(track.u), v_(track.v) {}
  proto::Result advance(const proto::Advance& request) override;
  void rollback(const proto::Rollback&) override { u_ = u_before_, v_ = v_before_; }
  void commit(const proto::Commit&) override {}
  void damp(double factor) { v_ *= factor; }
  double displacement() const { return u_; }
  double velocity() const { return v_; }

 protected:
  /// Mean over the window of the outer load [N].
  virtual double mean_load(const proto::Advance&) const { return track_.rail_load; }

 private:
  double solve_robin(const proto::Advance& request);  ///< returns the pad's mean force on the sleeper [N]
  void step(double h, double k, double c, double load);

  LumpedTrack track_;
  double u_, v_, u_before_ = 0.0, v_before_ = 0.0;
};

/// Sleeper mass: kick-drift-kick along the rail's straight or cubic path, or under a joint force; dashpots at the end
/// velocity of each sub-step.
class LumpedSleeper : public Side {
 public:
  explicit LumpedSleeper(const LumpedTrack& track) : track_(track), x_(track.x), y_(track.y) {}
  proto::Result advance(const proto::Advance& request) override;
  void rollback(const proto::Rollback&) override { x_ = x_before_, y_ = y_before_; }
  void commit(const proto::Commit&) override {}
  void damp(double factor) { y_ *= factor; }
  double displacement() const { return x_; }
  double velocity() const { return y_; }

 private:
  struct Sums {
    double impulse = 0.0, work = 0.0;
  };
  Sums along_path(const proto::Advance& request);
  Sums under_joint_force(const proto::Advance& request);

  LumpedTrack track_;
  double x_, y_, x_before_ = 0.0, y_before_ = 0.0;
};

}  // namespace coupler
